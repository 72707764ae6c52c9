// The reference: a level drawn by three.js from the same files, camera and exposure as Pliant's picture.
import * as THREE from 'three';
import { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

// shaders/tone.glsl, at the place that three.js keeps for a curve of one's own. A shared curve keeps the comparison to
// light and material.
THREE.ShaderChunk.tonemapping_pars_fragment = THREE.ShaderChunk.tonemapping_pars_fragment.replace(
  'vec3 CustomToneMapping( vec3 color ) { return color; }',
  `vec3 CustomToneMapping( vec3 color ) {
     vec3 x = toneMappingExposure * color;
     return clamp( x * ( 2.51 * x + 0.03 ) / ( x * ( 2.43 * x + 0.59 ) + 0.14 ), 0.0, 1.0 );
   }`);

const luminance = (r, g, b) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

// [lx] Mean irradiance of a panorama: pi times its mean radiance, a sun clipped at 20 times the mean luminance.
function meanIrradiance({ image: { data, width, height } }) {
  const read = data instanceof Uint16Array ? THREE.DataUtils.fromHalfFloat : (x) => x;
  const sum = (clip) => {
    let total = 0, sphere = 0;
    for (let y = 0; y < height; ++y) {
      const weight = Math.sin((Math.PI * (y + 0.5)) / height);
      for (let x = 0; x < width; ++x) {
        const i = 4 * (y * width + x);
        total += weight * Math.min(clip, luminance(read(data[i]), read(data[i + 1]), read(data[i + 2])));
        sphere += weight;
      }
    }
    return total / sphere;
  };
  return Math.PI * sum(20 * sum(Infinity));
}

// Which mesh each pixel's middle shows: 1, 2, 3..., and 0 where there is none.
function drawMask(renderer, scene, camera, meshes, width, height) {
  const target = new THREE.WebGLRenderTarget(width, height);
  const materials = meshes.map((mesh) => mesh.material), background = scene.background;
  meshes.forEach((mesh, i) => { mesh.material = new THREE.ShaderMaterial({
    vertexShader: 'void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }',
    fragmentShader: `void main() { gl_FragColor = vec4(${(i + 1).toFixed(1)} / 255.0, 0.0, 0.0, 1.0); }`,
  }); });
  scene.background = null;
  renderer.setRenderTarget(target);
  renderer.setClearColor(0, 0);
  renderer.clear();
  renderer.render(scene, camera);
  const rgba = new Uint8Array(4 * width * height);
  renderer.readRenderTargetPixels(target, 0, 0, width, height, rgba);
  renderer.setRenderTarget(null);
  meshes.forEach((mesh, i) => { mesh.material = materials[i]; });
  scene.background = background;
  const mask = new Uint8Array(width * height);  // first row on top
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) mask[y * width + x] = rgba[4 * ((height - 1 - y) * width + x)];
  return mask;
}

// Turns the directional lights' shadow maps on, fitted to the scene.
function castShadows(scene, meshes, lights) {
  const ball = new THREE.Box3().setFromObject(scene).getBoundingSphere(new THREE.Sphere());
  for (const mesh of meshes) mesh.castShadow = mesh.receiveShadow = true;
  for (const light of lights.filter((l) => l.isDirectionalLight)) {
    const towards = light.getWorldPosition(new THREE.Vector3()).sub(light.target.getWorldPosition(new THREE.Vector3()));
    scene.attach(light);
    scene.attach(light.target);
    light.target.position.copy(ball.center);
    light.position.copy(ball.center).addScaledVector(towards.normalize(), 2 * ball.radius);
    Object.assign(light.shadow.camera,
      { left: -ball.radius, right: ball.radius, bottom: -ball.radius,
        top: ball.radius, far: 4 * ball.radius, near: 0 });
    light.shadow.mapSize.set(2048, 2048);
    light.shadow.normalBias = 0.002 * ball.radius;
    light.castShadow = true;
  }
}

// Draws the glTF file at address `level` through its first camera: {canvas, mask, names of its bodies, exposure}.
export async function draw(level, width, height, shadows) {
  const renderer = new THREE.WebGLRenderer({ antialias: true });
  renderer.setSize(width, height, false);
  const draco = new DRACOLoader().setDecoderPath('/three/examples/jsm/libs/draco/gltf/');
  const gltf = await new GLTFLoader().setDRACOLoader(draco).loadAsync(level);
  const scene = new THREE.Scene().add(gltf.scene), camera = gltf.cameras[0];
  camera.aspect = width / height;
  camera.updateProjectionMatrix();
  scene.updateMatrixWorld(true);

  const given = gltf.parser.json.scenes[gltf.parser.json.scene].extensions.PLIANT_environment;
  const intensity = given.intensity ?? 1;
  const panorama = await new EXRLoader().loadAsync(new URL(given.panorama, new URL(level, location.href)).href);
  panorama.mapping = THREE.EquirectangularReflectionMapping;
  scene.environment = new THREE.PMREMGenerator(renderer).fromEquirectangular(panorama).texture;
  scene.background = panorama;
  scene.environmentIntensity = scene.backgroundIntensity = intensity;
  // A panorama's middle column lies towards +X in three.js, towards -Z here.
  scene.environmentRotation.y = scene.backgroundRotation.y = Math.PI / 2 + (given.rotation ?? 0);

  const meshes = [], lights = [];
  scene.traverse((o) => { if (o.isMesh) meshes.push(o); else if (o.isLight) lights.push(o); });
  const mask = drawMask(renderer, scene, camera, meshes, width, height);
  renderer.shadowMap.enabled = shadows;
  renderer.shadowMap.type = THREE.PCFShadowMap;
  if (shadows) castShadows(scene, meshes, lights);

  // As systems/visual exposes: a white sheet facing the key light.
  const key = lights.reduce((sum, l) => sum + l.intensity * luminance(l.color.r, l.color.g, l.color.b), 0);
  const exposure = (0.7 * Math.PI) / (key + intensity * meanIrradiance(panorama));
  renderer.toneMapping = THREE.CustomToneMapping;
  renderer.toneMappingExposure = exposure;
  renderer.render(scene, camera);
  const canvas = Object.assign(document.createElement('canvas'), { width, height });
  canvas.getContext('2d').drawImage(renderer.domElement, 0, 0);
  renderer.dispose();
  draco.dispose();
  return { canvas, mask, names: meshes.map((mesh) => mesh.name), exposure };
}
