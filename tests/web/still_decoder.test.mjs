import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
import { StillDecoder } from "../../clients/web/still_decoder.js";
import { settled } from "./support/fake_socket.mjs";

const packet = (sequence, encoding = 0) => ({ kind: 3, encoding, sequence, payload: new Uint8Array([sequence]) });

describe("a decoder of stills", () => {
  let shown, errors, begun, decoder;
  const bitmap = () => ({ closed: false, close() { this.closed = true; } });
  beforeEach(() => {
    [shown, errors, begun] = [[], [], []];
    const sink = { show: (_, p) => shown.push(p.sequence), need_key: assert.fail, fail: assert.fail, report: (e) => errors.push(e.message) };
    decoder = new StillDecoder(sink, (blob) => new Promise((resolve, reject) => begun.push({ type: blob.type, resolve, reject })));
  });

  test("decodes one at a time, and next the newest", async () => {
    [1, 2, 3].forEach((n) => decoder.push(packet(n)));
    assert.deepEqual(begun.map((b) => b.type), ["image/jpeg"]);
    begun[0].resolve(bitmap());
    await settled();
    assert.deepEqual([shown, begun.length], [[1], 2]);
    begun[1].resolve(bitmap());
    await settled();
    assert.deepEqual(shown, [1, 3]);
  });

  test("reports what is no picture, and goes on", async () => {
    decoder.push(packet(1));
    begun[0].reject(new Error("cut short"));
    await settled();
    decoder.push(packet(2, 2));
    await settled();
    decoder.push(packet(3, 1));
    begun[1].resolve(bitmap());
    await settled();
    assert.equal(errors.length, 2);
    assert.match(errors[0], /can't be decoded: cut short/);
    assert.match(errors[1], /expected a frame as jpeg or png/);
    assert.deepEqual(shown, [3]);
  });

  test("lets go of what was in the making when it was closed", async () => {
    decoder.push(packet(1));
    decoder.push(packet(2));
    decoder.close();
    const late = bitmap();
    begun[0].resolve(late);
    await settled();
    assert.ok(late.closed);
    assert.deepEqual([shown, begun.length], [[], 1]);
  });

  test("says nothing of it either", async () => {
    decoder.push(packet(1));
    decoder.close();
    begun[0].reject(new Error("cut short"));
    await settled();
    assert.deepEqual(errors, []);
  });
});
