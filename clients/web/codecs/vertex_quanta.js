/**
 * Positions on a grid over their bounds and octahedral normals, as q16 and meshopt have them: docs/PROTOCOL.md, sections 6.3
 * and 6.4.
 */
import { require_payload } from "./codec_error.js";

export const kGridBytes = 24;
const kPositionMost = 65535;

/** @typedef {{min: Float64Array, step: Float64Array}} Grid  xyz each */

/**
 * @param {DataView<ArrayBufferLike>} payload  that begins with min xyz and extent xyz
 * @param {Grid} grid                          is given what it says; unchanged where that is refused
 */
export function read_grid(payload, grid) {
  for (let k = 0; k < 3; k++) {
    const min = payload.getFloat32(4 * k, true);
    const extent = payload.getFloat32(12 + 4 * k, true);
    require_payload(
      Number.isFinite(min) && Number.isFinite(Math.fround(min + extent)) && extent >= 0,
      () => `expected finite bounds, found ${min} and an extent of ${extent} along axis ${k}`,
    );
  }
  for (let k = 0; k < 3; k++) {
    grid.min[k] = payload.getFloat32(4 * k, true);
    grid.step[k] = payload.getFloat32(12 + 4 * k, true) / kPositionMost;
  }
}

/** @returns {Grid} */
export function new_grid() {
  return { min: new Float64Array(3), step: new Float64Array(3) };
}

/**
 * Two integers to a direction of unit length, or to none.
 * @param {number} x
 * @param {number} y
 * @param {number} most  32767 at 16 bits, 2047 at 12
 * @param {Float32Array} out
 * @param {number} at  of the direction's x in `out`
 */
export function decode_octahedral(x, y, most, out, at) {
  if (x === -most - 1) {
    out[at] = out[at + 1] = out[at + 2] = 0;
    return;
  }
  let u = x / most;
  let v = y / most;
  const w = 1 - Math.abs(u) - Math.abs(v);
  if (w < 0) {
    const folded = (1 - Math.abs(v)) * (u < 0 ? -1 : 1);
    v = (1 - Math.abs(u)) * (v < 0 ? -1 : 1);
    u = folded;
  }
  const length = Math.sqrt(u * u + v * v + w * w);
  out[at] = u / length;
  out[at + 1] = v / length;
  out[at + 2] = w / length;
}
