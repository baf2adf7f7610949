/** Vertices as `meshopt`: docs/PROTOCOL.md, section 6.4. */
import { require_payload } from "./codec_error.js";
import { decode_octahedral, kGridBytes, new_grid, read_grid } from "./vertex_quanta.js";

const kPlanes = 5; // positions xyz, octahedral normals xy
const kNormalMost = 2047;
const kBlockVertices = 256;
const kStride = 12;

/**
 * What meshoptimizer's `MeshoptDecoder` (npm `meshoptimizer`, once its `ready` has resolved) can do; given by the caller, so
 * that this module loads nothing.
 * @typedef {{decodeVertexBuffer(target: Uint8Array, count: number, size: number, source: Uint8Array): void}} VertexDecoder
 */

/** Reads the packets of one stream in their order. */
export class VerticesMeshoptDecoder {
  /** @type {VertexDecoder} */
  #meshopt;
  #vertices = 0;
  #grid = new_grid();
  #residuals = new Uint8Array(0);
  /** Integers of each plane: [plane × vertices]. The three take turns. */
  #now = new Uint16Array(0);
  #before = new Uint16Array(0);
  #earlier = new Uint16Array(0);
  #is_known = false;

  /** @param {VertexDecoder} meshopt */
  constructor(meshopt) {
    this.#meshopt = meshopt;
  }

  /**
   * @param {Uint8Array} payload
   * @param {boolean} key             the packet's flag
   * @param {Float32Array} positions  n × 3
   * @param {Float32Array} normals    n × 3; unit length, or zero where there is none
   * @throws {import("./codec_error.js").CodecError} naming what was expected and found; the arrays are untouched then, and the next packet may follow the
   *   one before this
   */
  decode(payload, key, positions, normals) {
    const vertices = positions.length / 3;
    require_payload(
      key || (this.#is_known && vertices === this.#vertices),
      () => `expected a key of ${vertices} vertices first, found a packet that needs one`,
    );
    const blocks = Math.ceil(vertices / kBlockVertices);
    const first = key ? kGridBytes : 0;
    require_payload(
      payload.byteLength >= first + blocks,
      () => `expected ${first + blocks} bytes or more for ${vertices} vertices as meshopt, found ${payload.byteLength}`,
    );
    const foretellings = payload.subarray(first, first + blocks);
    check_foretellings(foretellings, key);
    this.#unpack(payload.subarray(first + blocks), vertices);
    if (key) read_grid(new DataView(payload.buffer, payload.byteOffset, payload.byteLength), this.#grid);
    this.#make_room(vertices); // nothing is refused from here on
    for (let block = 0; block < blocks; block++) {
      const nibbles = foretellings[block] ?? 0;
      const begin = block * kBlockVertices;
      const end = Math.min(vertices, begin + kBlockVertices);
      for (let k = 0; k < kPlanes; k++) this.#read_plane(k, k < 3 ? nibbles & 15 : nibbles >> 4, begin, end);
    }
    this.#write(positions, normals);
    this.#advance(key);
  }

  /** @param {number} vertices */
  #make_room(vertices) {
    if (vertices === this.#vertices) return;
    this.#vertices = vertices;
    this.#now = new Uint16Array(kPlanes * vertices);
    this.#before = new Uint16Array(kPlanes * vertices);
    this.#earlier = new Uint16Array(kPlanes * vertices);
  }

  /**
   * @param {Uint8Array} packed
   * @param {number} vertices
   */
  #unpack(packed, vertices) {
    if (this.#residuals.length !== vertices * kStride) this.#residuals = new Uint8Array(vertices * kStride);
    let found = "bytes of another kind";
    try {
      if (vertices > 0) this.#meshopt.decodeVertexBuffer(this.#residuals, vertices, kStride, packed);
      if (vertices > 0 || packed.byteLength === 0) return;
    } catch (error) {
      found = String(error);
    }
    require_payload(false, () => `expected ${vertices} vertices as meshoptimizer packs them, found ${found}`);
  }

  /**
   * @param {number} k  plane
   * @param {number} foretelling
   * @param {number} begin  vertex
   * @param {number} end
   */
  #read_plane(k, foretelling, begin, end) {
    const offset = k * this.#vertices;
    const now = this.#now.subarray(offset, offset + this.#vertices);
    const before = this.#before.subarray(offset, offset + this.#vertices);
    const earlier = this.#earlier.subarray(offset, offset + this.#vertices);
    const residuals = this.#residuals;
    // As factors, so that one loop does for all: by time f₁ · before + f₂ · earlier, by space likewise.
    const time = (foretelling / 3) | 0;
    const space = foretelling % 3;
    const f1 = time;
    const f2 = time === 2 ? -1 : 0;
    const g1 = space;
    const g2 = space === 2 ? -1 : 0;
    /** @param {number} v */
    const left = (v) => (v < 0 ? 0 : /** @type {number} */ (now[v]) - f1 * /** @type {number} */ (before[v]) - f2 * /** @type {number} */ (earlier[v]));
    let last = left(begin - 1);
    let second_last = left(begin - 2);
    let low = begin === 0 ? 0 : /** @type {number} */ (residuals[(begin - 1) * kStride + k]);
    let high = begin === 0 ? 0 : /** @type {number} */ (residuals[(begin - 1) * kStride + kPlanes + k]);
    for (let v = begin, at = begin * kStride + k; v < end; v++, at += kStride) {
      const next_low = /** @type {number} */ (residuals[at]);
      const next_high = /** @type {number} */ (residuals[at + kPlanes]);
      const residual = (((next_low - low) << 24) >> 24) + ((next_high - high) << 8);
      low = next_low;
      high = next_high;
      const here = (g1 * last + g2 * second_last + residual) & 0xffff;
      second_last = last;
      last = here;
      now[v] = here + f1 * /** @type {number} */ (before[v]) + f2 * /** @type {number} */ (earlier[v]);
    }
  }

  /**
   * @param {Float32Array} positions
   * @param {Float32Array} normals
   */
  #write(positions, normals) {
    const n = this.#vertices;
    const now = this.#now;
    for (let k = 0; k < 3; k++) {
      const min = /** @type {number} */ (this.#grid.min[k]);
      const step = /** @type {number} */ (this.#grid.step[k]);
      for (let v = 0, i = k; v < n; v++, i += 3) positions[i] = min + /** @type {number} */ (now[k * n + v]) * step;
    }
    for (let v = 0, i = 0; v < n; v++, i += 3) {
      const x = (/** @type {number} */ (now[3 * n + v]) << 16) >> 16;
      const y = (/** @type {number} */ (now[4 * n + v]) << 16) >> 16;
      decode_octahedral(x, y, kNormalMost, normals, i);
    }
  }

  /** @param {boolean} key  after which both packets before are it */
  #advance(key) {
    const free = this.#earlier;
    this.#earlier = this.#before;
    this.#before = this.#now;
    this.#now = free;
    if (key) this.#earlier.set(this.#before);
    this.#is_known = true;
  }
}

/**
 * @param {Uint8Array} foretellings
 * @param {boolean} key
 */
function check_foretellings(foretellings, key) {
  const most = key ? 3 : 9;
  for (const nibbles of foretellings) {
    require_payload(
      (nibbles & 15) < most && nibbles >> 4 < most,
      () => `expected foretellings below ${most} in a ${key ? "key" : "packet that is none"}, found 0x${nibbles.toString(16)}`,
    );
  }
}
