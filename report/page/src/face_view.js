// Draws one face by WebGL: a shaded surface with a colour per vertex, and control points. Knows nothing of experiments.

import {BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, HemisphereLight, InstancedMesh, Matrix4, Mesh,
  MeshLambertMaterial, MeshPhongMaterial, PerspectiveCamera, Scene, SphereGeometry, SRGBColorSpace, WebGLRenderer} from 'three';
import {Orbit} from './orbit.js';

const skin = [205, 178, 160], bridgedSkin = [228, 218, 212];

const linear = value => { const c = value / 255; return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; };
const fieldOfView = 24, heightMm = 235;

/** Null where the browser has no WebGL. */
export function faceView(canvas) {
  const context = canvas.getContext('webgl2', {antialias: true});
  if (!context) return null;
  return new FaceView(canvas, context);
}

class FaceView {
  constructor(canvas, context) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({canvas, context, antialias: true, alpha: true});
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.renderer.setClearAlpha(0);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(fieldOfView, 1, 10, 5000);
    this.geometry = new BufferGeometry();
    this.surface = new Mesh(this.geometry, new MeshPhongMaterial({vertexColors: true, side: DoubleSide, shininess: 8, specular: 0x1a1a1a}));
    this.scene.add(this.surface);
    this.light();
    this.markers = null;
    this.wanted = false;
    this.orbit = new Orbit(this.camera, canvas, heightMm / 2 / Math.tan(fieldOfView * Math.PI / 360), () => this.draw());
    new ResizeObserver(() => this.fit()).observe(canvas);
    this.fit();
  }
  light() {
    // As in figures: a key from above on the left, weak ones that keep the shadows open; they stand with the camera.
    const key = new DirectionalLight(0xffffff, 2.2), fill = new DirectionalLight(0xffffff, 0.5);
    key.position.set(-0.6, 0.9, 1);
    fill.position.set(1, -0.2, 0.8);
    this.camera.add(key, fill);
    this.sky = new HemisphereLight(0xffffff, 0xb0a8a0, 0.65);
    this.scene.add(this.camera, this.sky);
  }
  fit() {
    const {clientWidth, clientHeight} = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    // On a narrow screen the width decides how much is seen.
    this.camera.zoom = Math.min(1, this.camera.aspect * 1.15);
    this.camera.updateProjectionMatrix();
    this.draw();
  }
  /** surface: positions, triangles, bridges. colours: sRGB per vertex, 0 to 255, null: skin. */
  show(surface, colours) {
    const {positions, triangles, bridges} = surface;
    const shades = new Float32Array(positions.length);
    for (let v = 0; v < positions.length / 3; ++v) {
      const shade = colours?.[v] ?? (bridges[v] ? bridgedSkin : skin);
      for (let k = 0; k < 3; ++k) shades[3 * v + k] = linear(shade[k]);
    }
    // A geometry of its own for each surface: they have other numbers of vertices.
    this.geometry.dispose();
    this.geometry = this.surface.geometry = new BufferGeometry();
    this.geometry.setAttribute('position', new BufferAttribute(positions, 3));
    this.geometry.setAttribute('color', new BufferAttribute(shades, 3));
    this.geometry.setIndex(new BufferAttribute(triangles, 1));
    this.geometry.computeVertexNormals();
    this.geometry.computeBoundingSphere();
    this.sky.intensity = colours ? 1.7 : 0.65;  // a colour that says a number is shaded less
    this.draw();
  }
  /** markers: {position: [x, y, z], colour}. */
  mark(markers) {
    if (this.markers) {
      this.scene.remove(this.markers);
      this.markers.geometry.dispose();
      this.markers.material.dispose();
      this.markers.dispose();
    }
    this.markers = new InstancedMesh(new SphereGeometry(1.5, 12, 8), new MeshLambertMaterial(), markers.length);
    markers.forEach(({position, colour}, k) => {
      this.markers.setMatrixAt(k, new Matrix4().makeTranslation(...position));
      this.markers.setColorAt(k, new Color(colour));
    });
    this.markers.visible = markers.length > 0;
    this.scene.add(this.markers);
    this.draw();
  }
  draw() {
    if (this.wanted || !this.geometry.index) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.renderer.render(this.scene, this.camera);
      if (!this.canvas.dataset.firstPictureMs) this.canvas.dataset.firstPictureMs = String(Math.round(performance.now()));
    });
  }
}
