// Plays a clip with three.js's AnimationMixer for bench_pose_sampling, which starts this and writes a line for each thing it
// wants; each is answered by a line of JSON.
//   node mixer.mjs CLIP.json
//   show TIME     world matrices of all joints at TIME, column by column
//   forward N     nanoseconds of a step of 1/60 s, with and without world matrices, over N steps each
//   seek N        the same for steps to times all over the clip

import { readFileSync } from 'node:fs';
import { createInterface } from 'node:readline';
import { AnimationClip, AnimationMixer, Bone, QuaternionKeyframeTrack, VectorKeyframeTrack } from 'three';

const source = JSON.parse(readFileSync(process.argv[2], 'utf8'));

const bones = source.parents.map((parent, joint) => {
  const bone = new Bone();
  bone.name = `joint${joint}`;
  bone.position.fromArray(source.rest, 3 * joint);
  return bone;
});
source.parents.forEach((parent, joint) => parent >= 0 && bones[parent].add(bones[joint]));

const tracks = [];
for (let joint = 0; joint < bones.length; ++joint) {
  const add = (Track, property, values) => {
    if (values.length > 0) tracks.push(new Track(`joint${joint}.${property}`, source.times, values));
  };
  add(QuaternionKeyframeTrack, 'quaternion', source.rotations[joint]);
  add(VectorKeyframeTrack, 'position', source.translations[joint]);
  add(VectorKeyframeTrack, 'scale', source.scales[joint]);
}
const mixer = new AnimationMixer(bones[0]);
mixer.clipAction(new AnimationClip('clip', source.duration, tracks)).play();

/** Nanoseconds a call of `step` takes: the median of short batches, of which most are left alone by other processes. */
function timed(count, step) {
  const kBatch = 20;
  const batches = [];
  for (let done = 0; done < count; done += kBatch) {
    const start = process.hrtime.bigint();
    for (let i = done; i < done + kBatch; ++i) step(i);
    batches.push(Number(process.hrtime.bigint() - start) / kBatch);
  }
  return batches.sort((a, b) => a - b)[Math.floor(batches.length / 2)];
}

/** Times that jump all over the clip: multiples of the golden section. */
const jump = (i) => ((i * 0.6180339887498949) % 1) * source.duration;

const commands = {
  show(time) {
    mixer.setTime(time);
    bones[0].updateMatrixWorld(true);
    return bones.flatMap((bone) => bone.matrixWorld.elements);
  },
  forward: (count) => measured(count, () => mixer.update(1 / 60)),
  seek: (count) => measured(count, (i) => mixer.setTime(jump(i))),
};

function measured(count, step) {
  return [
    timed(count, (i) => {
      step(i);
      bones[0].updateMatrixWorld(true);
    }),
    timed(count, step),
  ];
}

for await (const line of createInterface({ input: process.stdin })) {
  const [name, argument] = line.split(' ');
  process.stdout.write(`${JSON.stringify(commands[name](Number(argument)))}\n`);
}
