/** Robots that drive in circles on an empty floor, by three.js and nothing else: as little as such a picture can ask. */
import * as THREE from "three";

const count = Number(new URLSearchParams(location.search).get("robots"));
const [width, height] = [innerWidth, innerHeight];
const renderer = new THREE.WebGLRenderer({ antialias: true });
renderer.setSize(width, height);
document.body.append(renderer.domElement);

const scene = new THREE.Scene();
const camera = new THREE.PerspectiveCamera(38, width / height, 0.1, 400);
camera.position.set(56, 80, 90);
camera.lookAt(56, 0, 37);
scene.add(new THREE.HemisphereLight("#ffffff", "#c8d0de", 1.7));
const sun = new THREE.DirectionalLight("#ffffff", 1.6);
sun.position.set(20, 90, 60);
scene.add(sun);
const floor = new THREE.Mesh(new THREE.PlaneGeometry(112, 74), new THREE.MeshLambertMaterial({ color: "#f4f6fa" }));
floor.rotateX(-Math.PI / 2).position.set(56, 0, 37);
scene.add(floor);
const body = new THREE.CylinderGeometry(0.36, 0.36, 0.7, 28).translate(0, 0.35, 0);
const robots = new THREE.InstancedMesh(body, new THREE.MeshLambertMaterial({ color: "#33415c" }), count);
robots.frustumCulled = false;
scene.add(robots);

const matrix = new THREE.Matrix4();
renderer.setAnimationLoop((now) => {
  for (let index = 0; index < count; index += 1) {
    const angle = now / 4000 + index;
    const [x, z] = [6 + (index % 10) * 11 + 1.5 * Math.cos(angle), 6 + Math.floor(index / 10) * 15 + 1.5 * Math.sin(angle)];
    robots.setMatrixAt(index, matrix.makeRotationY(angle).setPosition(x, 0, z));
  }
  robots.instanceMatrix.needsUpdate = true;
  renderer.render(scene, camera);
});
