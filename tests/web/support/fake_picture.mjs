/**
 * Pictures of nothing in particular that move with time and camera, for the fake server.
 */
import * as zlib from "node:zlib";

/** @type {(data: Buffer) => number} older Node has no zlib.crc32 */
const checksum = zlib.crc32 ?? ((data) => {
  let crc = ~0;
  for (const byte of data) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
});

/** @param {string} type @param {Buffer} data */
function chunk(type, data) {
  const body = Buffer.concat([Buffer.from(type), data]);
  const out = Buffer.alloc(body.length + 8);
  out.writeUInt32BE(data.length, 0);
  body.copy(out, 4);
  out.writeUInt32BE(checksum(body), body.length + 4);
  return out;
}

/** @param {number} width @param {number} height @param {Buffer} rows  a filter byte and RGB each */
function png(width, height, rows) {
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, 2, 0, 0, 0], 8);
  const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  return Buffer.concat([signature, chunk("IHDR", head), chunk("IDAT", zlib.deflateSync(rows, { level: 1 })), chunk("IEND", Buffer.alloc(0))]);
}

const kPoints = 900;

/**
 * A ball of points that swells with time, seen by the camera.
 * @param {number} width
 * @param {number} height
 * @param {{azimuth: number, elevation: number, distance: number, target: number[]}} orbit
 * @param {number} phase  0 … 1
 */
export function picture(width, height, orbit, phase) {
  const stride = 1 + 3 * width;
  const rows = Buffer.alloc(stride * height);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) rows.set([18, 20 + (y * 10) / height, 26], y * stride + 1 + 3 * x);
  }
  const { azimuth: a, elevation: e, distance, target } = orbit;
  const focal = height / 2 / Math.tan(Math.PI / 8);
  for (let i = 0; i < kPoints; ++i) {
    const z = 1 - (2 * i + 1) / kPoints;
    const turn = i * 2.399963;
    const radius = 1.6 + 0.7 * Math.sin(2 * Math.PI * phase + 4 * z);
    const flat = radius * Math.sqrt(1 - z * z);
    const [px, py, pz] = [flat * Math.cos(turn) - target[0], radius * z - target[1], flat * Math.sin(turn) - target[2]];
    const right = px * Math.cos(a) - pz * Math.sin(a);
    const back = px * Math.sin(a) * Math.cos(e) + py * Math.sin(e) + pz * Math.cos(a) * Math.cos(e);
    const up = py * Math.cos(e) - (px * Math.sin(a) + pz * Math.cos(a)) * Math.sin(e);
    const depth = distance - back;
    if (depth < 0.1) continue;
    const side = Math.max(1, Math.round(focal * 0.05 / depth));
    const [left, top] = [Math.round(width / 2 + (focal * right) / depth), Math.round(height / 2 - (focal * up) / depth)];
    const light = 0.35 + 0.65 / (1 + Math.exp(-2 * back));
    for (let y = Math.max(0, top - side); y < Math.min(height, top + side); ++y) {
      for (let x = Math.max(0, left - side); x < Math.min(width, left + side); ++x) {
        rows.set([224 * light, (150 + 60 * z) * light, 110 * light], y * stride + 1 + 3 * x);
      }
    }
  }
  return png(width, height, rows);
}
