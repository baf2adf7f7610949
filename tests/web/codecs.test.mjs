import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { MeshoptDecoder } from "meshoptimizer";
import { CodecError } from "../../clients/web/codecs/codec_error.js";
import { PoseQ16Decoder } from "../../clients/web/codecs/pose_q16.js";
import { VerticesMeshoptDecoder } from "../../clients/web/codecs/vertices_meshopt.js";
import { decode_vertices_q16 } from "../../clients/web/codecs/vertices_q16.js";
import { read_golden } from "./support/golden_packets.mjs";

await MeshoptDecoder.ready;

/**
 * The three alike: the golden file's floats in two halves, as each decoder takes them.
 * @type {Record<string, {file: string, decoder: () => (payload: Uint8Array, key: boolean, a: Float32Array, b: Float32Array) => void}>}
 */
const kCodecs = {
  "pose q16": {
    file: "pose_q16.bin",
    decoder: () => {
      const decoder = new PoseQ16Decoder();
      return (...packet) => decoder.decode(...packet);
    },
  },
  "vertices q16": {
    file: "vertices_q16.bin",
    decoder: () => (payload, _key, positions, normals) => decode_vertices_q16(payload, positions, normals),
  },
  "vertices meshopt": {
    file: "vertices_meshopt.bin",
    decoder: () => {
      const decoder = new VerticesMeshoptDecoder(MeshoptDecoder);
      return (...packet) => decoder.decode(...packet);
    },
  },
};

/** Arrays to read into, full of what no packet says. */
function room_for({ elements, weights, packets }) {
  const first = weights > 0 ? elements * 10 : packets[0].out.length / 2;
  return [new Float32Array(first).fill(-7), new Float32Array(packets[0].out.length - first).fill(-7)];
}

function refused(decode, payload, key, room, words) {
  const before = room.map((array) => array.slice());
  assert.throws(() => decode(payload, key, ...room), (error) => error instanceof CodecError && words.test(error.message));
  assert.deepEqual(room, before);
}

for (const [name, { file, decoder }] of Object.entries(kCodecs)) {
  const golden = read_golden(file);

  describe(name, () => {
    test("reads every packet to the last bit as the server's own decoder does", () => {
      assert.ok(golden.packets.length >= 4);
      const decode = decoder();
      const [a, b] = room_for(golden);
      for (const [i, { payload, key, out }] of golden.packets.entries()) {
        decode(payload, key, a, b);
        assert.deepEqual(Float32Array.from([...a, ...b]), out, `packet ${i}`);
      }
    });

    test("a reader that comes later begins with any key", () => {
      for (const [first, { key }] of golden.packets.entries()) {
        if (!key) continue;
        const decode = decoder();
        const [a, b] = room_for(golden);
        for (const packet of golden.packets.slice(first)) {
          decode(packet.payload, packet.key, a, b);
          assert.deepEqual(Float32Array.from([...a, ...b]), packet.out);
        }
      }
    });

    test("bytes need not begin where their buffer does", () => {
      const { payload, out } = golden.packets[0];
      const shifted = new Uint8Array(payload.length + 3);
      shifted.set(payload, 3);
      const [a, b] = room_for(golden);
      decoder()(shifted.subarray(3), true, a, b);
      assert.deepEqual(Float32Array.from([...a, ...b]), out);
    });

    test("refuses a packet cut anywhere, and goes on from the one before", () => {
      const decode = decoder();
      const room = room_for(golden);
      for (const { payload, key, out } of golden.packets.slice(0, 2)) {
        for (let size = 0; size < payload.length; size += 1 + (payload.length >> 7)) {
          refused(decode, payload.subarray(0, size), key, room, /^expected .* found/);
        }
        decode(payload, key, ...room);
        assert.deepEqual(Float32Array.from([...room[0], ...room[1]]), out);
      }
    });
  });
}

describe("packets that need another first", () => {
  for (const name of ["pose q16", "vertices meshopt"]) {
    test(`${name}: are refused without it`, () => {
      const golden = read_golden(kCodecs[name].file);
      refused(kCodecs[name].decoder(), golden.packets[1].payload, false, room_for(golden), /a key of \d+ .* first/);
    });
  }
  test("vertices meshopt: a key foretells nothing by time", () => {
    const golden = read_golden("vertices_meshopt.bin");
    const payload = golden.packets[0].payload.slice();
    payload[24] = 0x30;
    refused(kCodecs["vertices meshopt"].decoder(), payload, true, room_for(golden), /below 3 in a key, found 0x30/);
  });
});

test("vertices meshopt: a refused key of another size changes nothing", () => {
  const { packets } = read_golden("vertices_meshopt.bin");
  const decode = kCodecs["vertices meshopt"].decoder();
  const room = room_for({ elements: 0, weights: 0, packets });
  decode(packets[0].payload, true, ...room);
  const [one, other] = [new Float32Array(3), new Float32Array(3)];
  // A vertex: the byte of its block, and then none of meshoptimizer's.
  refused(decode, new Uint8Array(40), true, [one, other], /meshoptimizer packs/);
  decode(packets[1].payload, packets[1].key, ...room);
  assert.deepEqual(Float32Array.from([...room[0], ...room[1]]), packets[1].out);
});

describe("poses that are none", () => {
  const decode = (bytes) => [kCodecs["pose q16"].decoder(), Uint8Array.from(bytes), true, [new Float32Array(30), new Float32Array(2)]];
  test("unknown sections", () => refused(...decode([16]), /below 16, found 16/));
  test("bits beyond the joints", () => refused(...decode([1, 8]), /bits beyond/));
  test("bytes too many", () => refused(...decode([0, 1]), /the end/));
  test("no rotation", () => refused(...decode([2, 1, 0xff, 0x7f, 0xff, 0x7f, 0xff, 0x7f]), /expected a rotation/));
  test("the spare bit", () => refused(...decode([2, 1, 0, 0x40, 0, 0x40, 0, 0xc0]), /expected a rotation/));
  test("infinite bases", () => refused(...decode([8, 2, 0, 0, 0x80, 0x7f, 0]), /finite base/));
  test("exponents out of bounds", () => refused(...decode([8, 2, 0, 0, 0, 0, 81]), /exponent from -24 to 80/));
});

test("vertices that are none at all have their bounds alone", () => {
  const none = new Float32Array(0);
  decode_vertices_q16(new Uint8Array(24), none, none);
  const decoder = new VerticesMeshoptDecoder(MeshoptDecoder);
  decoder.decode(new Uint8Array(24), true, none, none);
  decoder.decode(new Uint8Array(0), false, none, none);
});
