// Turns a camera about the origin: drag, wheel, or keys (arrows, + and -, Home). Draws nothing itself.

const start = {turn: 0, tilt: 0, distance: 1};

export class Orbit {
  /** distanceMm: at zoom 1. changed: called after every move. */
  constructor(camera, canvas, distanceMm, changed) {
    Object.assign(this, start, {camera, distanceMm, changed});
    let from = null;
    canvas.addEventListener('pointerdown', event => {
      from = [event.clientX, event.clientY];
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener('pointermove', event => {
      if (!from) return;
      this.by(-0.008 * (event.clientX - from[0]), 0.008 * (event.clientY - from[1]), 1);
      from = [event.clientX, event.clientY];
    });
    for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, () => { from = null; });
    canvas.addEventListener('wheel', event => {
      if (!event.ctrlKey && document.activeElement !== canvas) return;  // else the page scrolls
      event.preventDefault();
      this.by(0, 0, Math.exp(0.001 * event.deltaY));
    }, {passive: false});
    canvas.addEventListener('keydown', event => {
      const step = 0.12;
      const moves = {ArrowLeft: [-step, 0, 1], ArrowRight: [step, 0, 1], ArrowUp: [0, step, 1], ArrowDown: [0, -step, 1], '+': [0, 0, 0.9], '=': [0, 0, 0.9], '-': [0, 0, 1.1]};
      if (event.key === 'Home') this.reset();
      else if (moves[event.key]) this.by(...moves[event.key]);
      else return;
      event.preventDefault();
    });
    this.place();
  }
  by(turn, tilt, zoom) {
    this.turn += turn;
    this.tilt = Math.min(1.4, Math.max(-1.4, this.tilt + tilt));
    this.distance = Math.min(3, Math.max(0.2, this.distance * zoom));
    this.place();
  }
  reset() {
    Object.assign(this, start);
    this.place();
  }
  place() {
    const distance = this.distance * this.distanceMm;
    this.camera.position.set(Math.sin(this.turn) * Math.cos(this.tilt), Math.sin(this.tilt), Math.cos(this.turn) * Math.cos(this.tilt)).multiplyScalar(distance);
    this.camera.lookAt(0, 0, 0);
    this.changed();
  }
}
