// The faces of the page with what moves and colours them: which face, expression and method; a slider per AU; the real
// scan to blink against; heat maps; control points.

import {choice, element, shown, tick} from './dom.js';
import {Face, quantile} from './face_geometry.js';
import {faceView} from './face_view.js';

const greyMm = [150, 150, 150], outsideZone = [196, 196, 196];
const markerColours = {muscle: '#cc2020', wrinkle: '#e09000', carried: '#b070c0'};
const blinkEveryMs = 700;

export class FacePanel {
  constructor(host, page, colours) {
    Object.assign(this, {host, page, colours});
    const {faces} = page;
    this.faces = new Map(faces.faces.map(packed => [packed.target, new Face(packed, faces.step_mm, faces.no_value)]));
    this.target = faces.faces[0].target;
    this.method = faces.methods.at(-1);
    // The expression that moves the face most is seen first.
    this.code = faces.faces[0].expressions.reduce((most, e) => (e.nothing.error_mm > most.nothing.error_mm ? e : most)).code;
    this.magnitudes = new Map();
    this.heat = 'none';
    this.zoneOnly = false;
    this.controls = false;
    this.real = false;
    this.blinking = null;
    this.turn = 0;
    this.build();
    this.onlyChosen(1);
  }
  get face() { return this.faces.get(this.target); }

  build() {
    this.canvas = element('canvas', {tabindex: 0, role: 'img', 'aria-describedby': 'face-keys'});
    this.view = faceView(this.canvas);
    if (!this.view) {
      this.host.replaceChildren(element('p', {class: 'notice'}, 'This browser draws no WebGL, so faces cannot be turned here. Pictures of them: mimik panels WORK --target SUBJECT --au 12 -o figures'));
      return;
    }
    this.what = element('p', {class: 'what'});
    this.status = element('p', {role: 'status', class: 'soft'});
    this.bar = element('div', {class: 'bar'});
    this.marks = element('p', {class: 'soft'}, ...Object.entries({muscle: 'muscle points', wrinkle: 'wrinkle points', carried: 'points carried along'}).flatMap(([kind, words]) =>
      [element('span', {class: 'swatch', style: {background: markerColours[kind]}}), ` ${words} `]));
    this.sliders = element('fieldset', {class: 'sliders'});
    this.notice = element('p', {class: 'notice', hidden: true});
    const keys = element('p', {id: 'face-keys', class: 'soft'}, 'Turn: drag, or arrows when the picture is focused; nearer: + and -, or the wheel; as at first: Home.');
    const left = element('div', {}, element('div', {class: 'stage'}, this.canvas, this.what), this.bar, this.marks, this.status, keys);
    const right = element('div', {}, this.fields(), this.sliders, this.buttons());
    this.host.replaceChildren(this.notice, element('div', {class: 'face-panel'}, left, right));
  }
  fields() {
    const {faces} = this.page;
    this.targetChoice = choice('face', faces.faces.map(f => [f.target, `${f.target} (${f.why})`]), this.target, value => this.goTo({target: value}));
    this.methodChoice = choice('method', faces.methods.map(name => [name, this.page.method(name)?.title ?? name]), this.method, value => this.goTo({method: value}));
    this.heatChoice = choice('colour', [['none', 'skin'], ['distance', 'distance to the real scan, mm'], ['motion', 'motion of the skin, mm']], this.heat, value => { this.heat = value; this.draw(); });
    this.zoneTick = tick('zone alone', this.zoneOnly, on => { this.zoneOnly = on; this.draw(); });
    this.controlTick = tick('control points', this.controls, on => { this.controls = on; this.draw(); });
    return element('div', {class: 'fields'}, this.targetChoice.field, this.methodChoice.field, this.heatChoice.field, this.zoneTick.field, this.controlTick.field);
  }
  buttons() {
    this.realButton = element('button', {type: 'button', class: 'plain', 'aria-pressed': 'false', onclick: () => this.showReal(!this.real)}, 'Real scan');
    this.blinkButton = element('button', {type: 'button', class: 'plain', 'aria-pressed': 'false', onclick: () => this.blink(!this.blinking)}, 'Blink');
    return element('div', {class: 'fields'}, this.realButton, this.blinkButton,
      element('button', {type: 'button', class: 'plain', onclick: () => this.onlyChosen(1)}, 'Chosen alone at 1'),
      element('button', {type: 'button', class: 'plain', onclick: () => this.onlyChosen(0)}, 'Neutral'),
      element('button', {type: 'button', class: 'plain', onclick: () => this.view.orbit.reset()}, 'Front'));
  }
  fillSliders() {
    const legend = element('legend', {}, 'Expressions: the chosen one is compared with its real scan');
    this.sliders.replaceChildren(legend, ...this.face.packed.expressions.map(({code}) => {
      const label = this.page.label(code), magnitude = this.magnitudes.get(code) ?? 0;
      const there = Boolean(this.face.shape(code, this.method));
      const value = element('output', {}, shown(magnitude, 2));
      const range = element('input', {type: 'range', min: 0, max: 1.5, step: 0.05, 'aria-label': `magnitude of ${label}`, disabled: !there,
        oninput: () => { this.magnitudes.set(code, Number(range.value)); value.textContent = shown(Number(range.value), 2); this.draw(); }});
      range.value = String(magnitude);
      const radio = element('input', {type: 'radio', name: 'chosen-expression', value: code, checked: code === this.code, 'aria-label': `compare ${label}`,
        onchange: () => this.goTo({expression: code})});
      return element('div', {class: code === this.code ? 'slider chosen' : 'slider'}, radio, element('span', {}, label), range, value);
    }));
  }

  /** Where a table leads: what is not given stays. */
  goTo({target, expression, method}) {
    if (!this.view) return;
    const missing = target !== undefined && !this.faces.has(target);
    this.notice.hidden = !missing;
    if (missing) {
      this.notice.textContent = `The face of ${target} is not on this page. This makes a page with it: mimik report OUT --target ${target}`;
      return;
    }
    const before = this.code;
    this.target = target ?? this.target;
    method = method?.split('@')[0]; // rows of mean@0.8 are of the method mean; its slider has the magnitude
    if (method !== undefined && this.page.faces.methods.includes(method)) this.method = method;
    else if (method !== undefined) {
      this.notice.hidden = false;
      this.notice.textContent = `The motion by ${method} is not on this page; ${this.method} is shown. This makes a page with it: mimik report OUT --method ${method}`;
    }
    if (expression !== undefined && this.face.expression(expression)) this.code = expression;
    if (!this.face.expression(this.code)) this.code = this.face.packed.expressions[0].code;
    this.targetChoice.list.value = this.target;
    this.methodChoice.list.value = this.method;
    if (expression !== undefined || this.code !== before) this.onlyChosen(1);
    else { this.fillSliders(); this.draw(); }
  }
  onlyChosen(magnitude) {
    if (!this.view) return;
    this.magnitudes = new Map([[this.code, magnitude]]);
    const focused = document.activeElement?.name === 'chosen-expression';
    this.fillSliders();
    if (focused) this.sliders.querySelector('input[type=radio]:checked')?.focus();
    this.draw();
  }
  showReal(on) {
    this.real = on;
    this.realButton.setAttribute('aria-pressed', String(on));
    this.draw();
  }
  blink(on) {
    clearInterval(this.blinking);
    this.blinking = on ? setInterval(() => this.showReal(!this.real), blinkEveryMs) : null;
    this.blinkButton.setAttribute('aria-pressed', String(on));
    if (!on) this.showReal(false);
  }

  /** Distances are known where a row has them: of the chosen expression alone at 1, and of the neutral face. */
  async distances() {
    const settings = [...this.magnitudes].filter(([, magnitude]) => magnitude !== 0);
    if (settings.length === 0) return this.face.nothing(this.code);
    if (settings.length === 1 && settings[0][0] === this.code && settings[0][1] === 1) return (await this.face.motion(this.code, this.method))?.distance ?? null;
    return null;
  }
  async coloured(animated) {
    if (this.heat === 'none') return {colours: null};
    const values = this.heat === 'motion' ? animated.length : await this.distances();
    const most = this.heat === 'motion' ? Math.max(0.5, (await this.face.motion(this.code, this.method))?.largest ?? 0)
      : Math.max(0.5, quantile(await this.face.nothing(this.code), 0.99));
    const scale = Math.ceil(most * 2) / 2;
    const zone = this.zoneOnly ? await this.face.zone(this.code) : null;
    const colours = Array.from({length: animated.length.length}, (_, v) => {
      if (zone && !zone[v]) return outsideZone;
      const value = values ? values[v] : NaN;
      return Number.isNaN(value) ? greyMm : this.colours.at(value / scale);
    });
    return {colours, scale, known: values !== null};
  }
  async draw() {
    if (!this.view) return;
    const turn = ++this.turn;
    const {face, code, method} = this;
    const animated = await face.animated(method, this.magnitudes);
    const {colours, scale, known} = await this.coloured(animated);
    const surface = this.real ? await face.real(code) : animated;
    if (turn !== this.turn) return;  // something newer is asked for
    this.view.show(surface, this.real ? null : colours);
    this.view.mark(this.controls && !this.real ? face.expression(code).controls.map(({vertex, kind}) =>
      ({position: [...animated.positions.subarray(3 * vertex, 3 * vertex + 3)], colour: markerColours[kind] ?? '#808080'})) : []);
    this.say(animated, scale, known);
  }
  say(animated, scale, known) {
    const {face, code, method} = this;
    const shape = face.shape(code, method), label = this.page.label(code);
    const nothing = face.expression(code).nothing.error_mm;
    this.what.textContent = this.real ? `${this.target}: ${this.page.data.synthetic ? 'synthetic' : 'real'} scan of ${label}` : `${this.target}: ${method}${shape?.source && shape.source !== 'mean' ? ` from ${shape.source}` : ''}`;
    this.canvas.setAttribute('aria-label', `${this.what.textContent}, ${label}`);
    const score = shape ? `${label} at 1: ${shown(shape.error_mm, 2)} mm off the real scan in the zone, doing nothing ${shown(nothing, 2)} mm, explained ${shown(1 - shape.error_mm / nothing, 2)}.` : `${method} has no answer for ${label}.`;
    const lost = known === false ? ' The distance is known for the chosen expression alone at 1, and for the neutral face: grey.' : '';
    this.status.textContent = `Largest motion shown: ${shown(animated.largest, 1)} mm. ${score}${lost}`;
    this.bar.hidden = this.heat === 'none' || this.real;
    if (!this.bar.hidden) this.bar.replaceChildren('0', element('i', {style: {background: this.colours.gradient()}}), `${shown(scale, 1)} mm`,
      element('span', {}, this.heat === 'motion' ? 'motion' : 'distance', ' ', element('span', {class: 'swatch', style: {background: `rgb(${greyMm.join(' ')})`}}), ' unknown'));
    this.marks.hidden = !this.controls;
  }
}
