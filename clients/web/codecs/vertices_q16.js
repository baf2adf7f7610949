/** Vertices as `q16`: docs/PROTOCOL.md, section 6.3. Every packet decodes on its own. */
import { require_payload } from "./codec_error.js";
import { decode_octahedral, kGridBytes, new_grid, read_grid } from "./vertex_quanta.js";

const kVertexBytes = 10;
const kMost = 32767;

/**
 * @param {Uint8Array} payload
 * @param {Float32Array} positions  n × 3
 * @param {Float32Array} normals    n × 3; unit length, or zero where there is none
 * @throws {import("./codec_error.js").CodecError} naming what was expected and found; the arrays are untouched then
 */
export function decode_vertices_q16(payload, positions, normals) {
  const vertices = positions.length / 3;
  const bytes = kGridBytes + kVertexBytes * vertices;
  require_payload(
    payload.byteLength === bytes,
    () => `expected ${bytes} bytes for ${vertices} vertices as q16, found ${payload.byteLength}`,
  );
  const view = new DataView(payload.buffer, payload.byteOffset, payload.byteLength);
  const grid = new_grid();
  read_grid(view, grid);
  for (let k = 0; k < 3; k++) {
    const min = /** @type {number} */ (grid.min[k]);
    const step = /** @type {number} */ (grid.step[k]);
    for (let i = k, at = kGridBytes + 2 * k; i < positions.length; i += 3, at += 6) {
      positions[i] = min + view.getUint16(at, true) * step;
    }
  }
  let at = kGridBytes + 2 * positions.length;
  for (let i = 0; i < normals.length; i += 3, at += 4) {
    decode_octahedral(view.getInt16(at, true), view.getInt16(at + 2, true), kMost, normals, i);
  }
}
