/**
 * The header of stream packets: docs/PROTOCOL.md, section 6. Little-endian throughout.
 */

export const kHeaderBytes = 40;
export const kKindFrame = 3;
export const kEncodingH264 = 2;
export const kFlagKey = 1;
export const kFlagDiscontinuity = 2;
export const kFlagLast = 4;

const kMagic = 0x444e5754; // "TWND"
const kVersion = 1;

/** Frame encodings by their number; null: none that an image decoder takes. */
const kImageTypes = ["image/jpeg", "image/png"];

/**
 * @typedef {object} Packet
 * @property {number} kind       1 pose, 2 vertices, 3 frame
 * @property {number} encoding
 * @property {boolean} key
 * @property {boolean} discontinuity
 * @property {boolean} last      nothing follows until something changes
 * @property {number} stream
 * @property {number} sequence
 * @property {number} media_s    media time, seconds
 * @property {number} server_us  the server's clock reading at which that media time holds
 * @property {number} revision
 * @property {Uint8Array<ArrayBuffer>} payload  shares the packet's bytes
 */

/** Bytes that are no packet of ours. */
export class PacketError extends Error {}

/**
 * @param {ArrayBuffer} bytes  one binary message
 * @returns {Packet}
 * @throws {PacketError} naming what was expected and found
 */
export function decode_packet(bytes) {
  if (bytes.byteLength < kHeaderBytes) {
    throw new PacketError(`expected a packet of at least ${kHeaderBytes} bytes, found ${bytes.byteLength}`);
  }
  const view = new DataView(bytes);
  const magic = view.getUint32(0, true);
  if (magic !== kMagic) {
    throw new PacketError(`expected a packet that begins with "TWND", found 0x${magic.toString(16)}`);
  }
  const version = view.getUint8(4);
  if (version !== kVersion) {
    throw new PacketError(`expected packet version ${kVersion}, found ${version}; reload the page`);
  }
  const payload_bytes = view.getUint32(36, true);
  if (payload_bytes !== bytes.byteLength - kHeaderBytes) {
    throw new PacketError(`expected a payload of ${payload_bytes} bytes, found ${bytes.byteLength - kHeaderBytes}`);
  }
  const flags = view.getUint8(7);
  return {
    kind: view.getUint8(5),
    encoding: view.getUint8(6),
    key: (flags & kFlagKey) !== 0,
    discontinuity: (flags & kFlagDiscontinuity) !== 0,
    last: (flags & kFlagLast) !== 0,
    stream: view.getUint32(8, true),
    sequence: view.getUint32(12, true),
    // A double counts microseconds exactly for 285 years.
    media_s: Number(view.getBigInt64(16, true)) / 1e6,
    server_us: Number(view.getBigInt64(24, true)),
    revision: view.getUint32(32, true),
    payload: new Uint8Array(bytes, kHeaderBytes),
  };
}

/**
 * What an image decoder has to be told about a packet's payload.
 * @param {Packet} packet
 * @returns {string} a MIME type
 * @throws {PacketError} if it is no picture, or one that is not decoded here
 */
export function image_type(packet) {
  const type = packet.kind === kKindFrame ? kImageTypes[packet.encoding] : undefined;
  if (!type) {
    throw new PacketError(`expected a frame as jpeg or png, found kind ${packet.kind}, encoding ${packet.encoding}`);
  }
  return type;
}
