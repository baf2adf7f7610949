// Reads a .glb with three.js's GLTFLoader for bench_gltf_import, which starts this and writes a line for each thing it wants;
// each is answered by a line of JSON.
//   node loader.mjs FILE.glb
//   show 0        vertices, triangles, nodes and animations
//   load N        milliseconds of a load from memory, the median of N

import { readFileSync } from 'node:fs';
import { createInterface } from 'node:readline';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';

const file = readFileSync(process.argv[2]);
const bytes = file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
const load = () => new GLTFLoader().parseAsync(bytes, '');

const commands = {
  async show() {
    const { scene, animations } = await load();
    let vertices = 0;
    let triangles = 0;
    let nodes = 0;
    scene.traverse((object) => {
      // A mesh of several primitives becomes a group of meshes, which glTF does not know as nodes.
      if (object !== scene) ++nodes;
      if (!object.isMesh) return;
      vertices += object.geometry.attributes.position.count;
      triangles += object.geometry.index.count / 3;
    });
    return [vertices, triangles, nodes, animations.length];
  },
  async load(count) {
    const times = [];
    for (let i = 0; i < count; ++i) {
      const start = process.hrtime.bigint();
      await load();
      times.push(Number(process.hrtime.bigint() - start) / 1e6);
    }
    return [times.sort((a, b) => a - b)[Math.floor(count / 2)], times[0]];
  },
};

for await (const line of createInterface({ input: process.stdin })) {
  const [name, argument] = line.split(' ');
  process.stdout.write(`${JSON.stringify(await commands[name](Number(argument)))}\n`);
}
