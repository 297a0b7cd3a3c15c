// glb_in_chromium.mjs CHROMIUM NODE_MODULES FOLDER FILE.glb...: moving faces in a browser, by three.js. Of each file
// pictures at three times stay in FOLDER.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {readFileSync, writeFileSync} from 'node:fs';
import {basename, join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';
import {Chromium} from './chromium.mjs';

const [program, modules, folder, ...files] = process.argv.slice(2);
const claim = text => console.log(`ok: ${text}`);

// The viewer: everybody's loader and everybody's mixer.
writeFileSync(join(folder, 'viewer.mjs'), `
import * as THREE from 'three';
import {GLTFLoader} from 'three/examples/jsm/loaders/GLTFLoader.js';
const renderer = new THREE.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
renderer.setSize(innerWidth, innerHeight);
document.body.append(renderer.domElement);
const scene = new THREE.Scene();
scene.background = new THREE.Color(0x4466aa);
const camera = new THREE.PerspectiveCamera(30, innerWidth / innerHeight, 0.01, 10);
const lamp = new THREE.DirectionalLight(0xffffff, 2.5);
lamp.position.set(-0.4, 0.5, 1);
scene.add(lamp, new THREE.AmbientLight(0xffffff, 0.6));
window.show = async base64 => {
  const bytes = Uint8Array.from(atob(base64), c => c.charCodeAt(0));
  const gltf = await new GLTFLoader().parseAsync(bytes.buffer, '');
  scene.add(gltf.scene);
  let mesh;
  gltf.scene.traverse(o => { if (o.isMesh) mesh = o; });
  const box = new THREE.Box3().setFromBufferAttribute(mesh.geometry.attributes.position).applyMatrix4(mesh.matrixWorld);
  mesh.updateWorldMatrix(true, false);
  box.setFromBufferAttribute(mesh.geometry.attributes.position).applyMatrix4(mesh.matrixWorld);
  const middle = box.getCenter(new THREE.Vector3()), size = box.getSize(new THREE.Vector3());
  camera.position.set(middle.x, middle.y, middle.z + 2.4 * size.y);
  camera.lookAt(middle);
  const mixer = new THREE.AnimationMixer(gltf.scene);
  gltf.animations.forEach(clip => {
    const action = mixer.clipAction(clip);
    action.setLoop(THREE.LoopOnce);  // or the last frame would be the first again
    action.clampWhenFinished = true;
    action.play();
  });
  window.at = seconds => {
    gltf.animations.forEach(clip => mixer.clipAction(clip).reset());
    mixer.setTime(seconds);
    renderer.render(scene, camera);
    return [...mesh.morphTargetInfluences];
  };
  return {animations: gltf.animations.length, seconds: gltf.animations[0]?.duration, height: size.y,
    targets: Object.keys(mesh.morphTargetDictionary)};
};
`);
execFileSync(join(modules, '.bin', 'esbuild'), [join(folder, 'viewer.mjs'), '--bundle', '--format=iife', '--minify',
  '--log-level=error', `--outfile=${join(folder, 'viewer.js')}`], {env: {...process.env, NODE_PATH: modules}});
writeFileSync(join(folder, 'viewer.html'), '<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,">' +
  '<style>body{margin:0}canvas{display:block}</style><body><script src="viewer.js"></script></body>');

/** JSON, and the numbers of an accessor. */
function decoded(file) {
  const bytes = readFileSync(file);
  const length = bytes.readUInt32LE(12), json = JSON.parse(bytes.subarray(20, 20 + length));
  const body = bytes.subarray(28 + length);
  const numbers = k => {
    const {bufferView, byteOffset = 0, count} = json.accessors[k], view = json.bufferViews[bufferView];
    const first = (view.byteOffset ?? 0) + byteOffset;
    return Array.from({length: count}, (_, i) => body.readFloatLE(first + 4 * i));
  };
  return {json, numbers};
}

const browser = new Chromium(program);
try {
  for (const file of files) {
    const name = basename(file, '.glb');
    const {json, numbers} = decoded(file);
    const sampler = json.animations[0].samplers[0];
    const times = numbers(sampler.input), weights = numbers(sampler.output), targets = json.meshes[0].extras.targetNames;
    const page = await browser.page();
    await page.open(pathToFileURL(resolve(folder, 'viewer.html')).href, {width: 480, height: 600});
    await page.until('typeof window.show === "function"');
    const shown = await page.value(`window.show(${JSON.stringify(readFileSync(file).toString('base64'))})`);
    assert.equal(shown.animations, 1);
    assert.deepEqual(shown.targets, targets);
    assert.ok(Math.abs(shown.seconds - times.at(-1)) < 1e-5, `${shown.seconds} s and not ${times.at(-1)}`);
    assert.ok(shown.height > 0.1 && shown.height < 0.5, `a face is ${shown.height} m high`);
    // The face at rest, and the two frames that are farthest from it: of the whole, and of the rest of the take.
    const row = frame => weights.slice(frame * targets.length, (frame + 1) * targets.length);
    const away = times.map((_, frame) => Math.hypot(...row(frame).map((w, k) => w - weights[k])));
    const farthest = among => among.reduce((best, frame) => (away[frame] > away[best] ? frame : best), among[0]);
    const all = times.map((_, frame) => frame), first = farthest(all);
    const second = farthest(all.filter(frame => Math.abs(frame - first) > times.length / 8));
    const pictures = [];
    for (const frame of [0, first, second]) {
      const influences = await page.value(`window.at(${times[frame]})`);
      row(frame).forEach((w, k) => assert.ok(Math.abs(influences[k] - w) < 1e-4, `frame ${frame}: ${targets[k]} is ${influences[k]} and not ${w}`));
      pictures.push(await page.picture());
      writeFileSync(join(folder, `${name}_${frame}.png`), pictures.at(-1));
    }
    assert.ok(!pictures[0].equals(pictures[1]) && !pictures[0].equals(pictures[2]), 'the face does not move');
    assert.deepEqual(page.faults, []);
    claim(`${name}: ${targets.length} targets over ${shown.seconds.toFixed(2)} s move the face as the file says`);
  }
} finally {
  await browser.close();
}
