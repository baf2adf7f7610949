import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { PacketError, decode_packet, image_type } from "../../clients/web/packet.js";

/** A frame as the server writes it: docs/PROTOCOL.md, section 6. Bytes by hand, so that a slip in a helper can't hide one here. */
const kFrame = Uint8Array.from([
  0x54, 0x57, 0x4e, 0x44, // TWND
  1, 3, 0, 0b101, // version, frame, jpeg, key and last
  7, 0, 0, 0, // stream
  0x02, 0x01, 0, 0, // sequence 258
  0x60, 0xe3, 0x16, 0, 0, 0, 0, 0, // media time 1.5 s
  0x00, 0x40, 0x11, 0x14, 0x1e, 0x0b, 0x00, 0x00, // clock
  9, 0, 0, 0, // revision
  3, 0, 0, 0, // payload
  0xff, 0xd8, 0xff,
]);

/** @param {Record<number, number>} changes */
function with_bytes(changes) {
  const bytes = kFrame.slice();
  for (const [at, value] of Object.entries(changes)) bytes[Number(at)] = value;
  return bytes.buffer;
}

const refused = (bytes, words) =>
  assert.throws(() => decode_packet(bytes), (error) => error instanceof PacketError && words.test(error.message));

describe("packets that are refused", () => {
  test("too short for a header", () => refused(kFrame.slice(0, 39).buffer, /at least 40 bytes, found 39/));
  test("of another kind of file", () => refused(with_bytes({ 0: 0x50 }), /TWND.*0x444e5750/));
  test("of another version", () => refused(with_bytes({ 4: 2 }), /version 1, found 2/));
  test("cut short", () => refused(kFrame.slice(0, 42).buffer, /3 bytes, found 2/));
  test("with bytes too many", () => refused(Uint8Array.from([...kFrame, 0]).buffer, /3 bytes, found 4/));
});

test("a header says what it holds", () => {
  const { payload, ...rest } = decode_packet(kFrame.slice().buffer);
  assert.deepEqual(rest, {
    kind: 3, encoding: 0, key: true, discontinuity: false, last: true, stream: 7, sequence: 258, media_s: 1.5,
    server_us: 0x0b1e14114000, revision: 9,
  });
  assert.deepEqual([...payload], [0xff, 0xd8, 0xff]);
});

test("times may be negative, numbers use all their bits", () => {
  const bytes = kFrame.slice();
  bytes.set([0xff, 0xff, 0xff, 0xff], 8);
  bytes.set([0xc0, 0xbd, 0xf0, 0xff, 0xff, 0xff, 0xff, 0xff], 16); // -1,000,000
  bytes[7] = 2;
  const packet = decode_packet(bytes.buffer);
  assert.equal(packet.stream, 0xffffffff);
  assert.equal(packet.media_s, -1);
  assert.deepEqual([packet.key, packet.discontinuity, packet.last], [false, true, false]);
});

test("the payload is not copied", () => {
  const { buffer } = kFrame.slice();
  assert.equal(decode_packet(buffer).payload.buffer, buffer);
});

test("pictures have a type, other packets have none", () => {
  assert.equal(image_type(decode_packet(with_bytes({}))), "image/jpeg");
  assert.equal(image_type(decode_packet(with_bytes({ 6: 1 }))), "image/png");
  assert.throws(() => image_type(decode_packet(with_bytes({ 6: 2 }))), /jpeg or png, found kind 3, encoding 2/);
  assert.throws(() => image_type(decode_packet(with_bytes({ 5: 2 }))), /found kind 2/);
});
