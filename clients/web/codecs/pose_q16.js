/** Poses as `q16`: docs/PROTOCOL.md, section 6.2. */
import { require_payload } from "./codec_error.js";

const kFloatsPerJoint = 10;
const kRotationAt = 3;
const kScaleAt = 7;
const kRotationBytes = 6;
const kMostSteps = 16383;
const kPerUnit = kMostSteps * Math.SQRT2;
const kLeastExponent = -24;
const kMostExponent = 80;

/** Values as base + integer · step. */
class RangedValues {
  /**
   * @param {number} components     of an element
   * @param {number} rest           base of the elements that a key does not name
   * @param {number} rest_exponent  likewise
   */
  constructor(components, rest, rest_exponent) {
    this.components = components;
    this.rest = rest;
    this.rest_exponent = rest_exponent;
    this.base = new Float32Array(0);
    this.step = new Float64Array(0);
  }

  /** @param {number} elements */
  reset(elements) {
    if (this.step.length !== elements) {
      this.base = new Float32Array(elements * this.components);
      this.step = new Float64Array(elements);
    }
    this.base.fill(this.rest);
    this.step.fill(2 ** this.rest_exponent);
  }

  /** @param {boolean} key */
  record_bytes(key) {
    return key ? 4 * this.components + 1 : 2 * this.components;
  }

  /**
   * @param {DataView<ArrayBufferLike>} view
   * @param {Section} section  of a key
   */
  check(view, section) {
    for (let i = 0, at = section.records; i < section.count; i++, at += this.record_bytes(true)) {
      for (let k = 0; k < this.components; k++) {
        const base = view.getFloat32(at + 4 * k, true);
        require_payload(Number.isFinite(base), () => `expected a finite base, found ${base} in record ${i}`);
      }
      const exponent = view.getInt8(at + 4 * this.components);
      require_payload(
        exponent >= kLeastExponent && exponent <= kMostExponent,
        () => `expected an exponent from ${kLeastExponent} to ${kMostExponent}, found ${exponent} in record ${i}`,
      );
    }
  }

  /**
   * @param {DataView<ArrayBufferLike>} view
   * @param {Section} section
   * @param {boolean} key
   * @param {Float32Array} out
   * @param {number} offset  of the first element in `out`
   * @param {number} stride  from one to the next
   */
  read(view, section, key, out, offset, stride) {
    if (section.count === 0) return;
    let at = section.records;
    for (let e = 0; e < this.step.length; e++) {
      if (!bit(view, section.bitmap, e)) continue;
      const step = /** @type {number} */ (this.step[e]);
      for (let k = 0; k < this.components; k++) {
        const i = e * this.components + k;
        if (key) this.base[i] = view.getFloat32(at + 4 * k, true);
        const steps = key ? 0 : view.getInt16(at + 2 * k, true);
        out[offset + e * stride + k] = /** @type {number} */ (this.base[i]) + steps * step;
      }
      if (key) this.step[e] = 2 ** view.getInt8(at + 4 * this.components);
      at += this.record_bytes(key);
    }
  }
}

/**
 * Where a section's parts are in the payload; zeros for one that is absent.
 * @typedef {{bitmap: number, records: number, count: number}} Section
 */

/** Reads the packets of one stream in their order. */
export class PoseQ16Decoder {
  #translations = new RangedValues(3, 0, -17);
  #scales = new RangedValues(3, 1, -14);
  #weights = new RangedValues(1, 0, -14);
  /** As packets have said: the joints, then the weights. */
  #pose = new Float32Array(0);
  #joints = -1;
  /** @type {[Section, Section, Section, Section]} */
  #sections = [new_section(), new_section(), new_section(), new_section()];

  /**
   * @param {Uint8Array} payload
   * @param {boolean} key           the packet's flag
   * @param {Float32Array} joints   is given the whole pose: joints × 10, translation xyz, rotation xyzw, scale xyz
   * @param {Float32Array} weights  likewise
   * @throws {import("./codec_error.js").CodecError} naming what was expected and found; the arrays are untouched then, and the next packet may follow the
   *   one before this
   */
  decode(payload, key, joints, weights) {
    const count = joints.length / kFloatsPerJoint;
    const is_same = count === this.#joints && weights.length === this.#weights.step.length;
    require_payload(
      key || is_same,
      () => `expected a key of ${count} joints and ${weights.length} weights first, found a packet that needs one`,
    );
    const view = new DataView(payload.buffer, payload.byteOffset, payload.byteLength);
    this.#take_apart(view, key, count, weights.length);
    const [translations, rotations, scales, weight_section] = this.#sections;
    check_rotations(view, rotations);
    if (key) {
      this.#translations.check(view, translations);
      this.#scales.check(view, scales);
      this.#weights.check(view, weight_section);
      this.#rest(count, weights.length);
    }
    const pose = this.#pose;
    this.#translations.read(view, translations, key, pose, 0, kFloatsPerJoint);
    read_rotations(view, rotations, count, pose);
    this.#scales.read(view, scales, key, pose, kScaleAt, kFloatsPerJoint);
    this.#weights.read(view, weight_section, key, pose, joints.length, 1);
    for (let i = 0; i < joints.length; i++) joints[i] = /** @type {number} */ (pose[i]);
    for (let i = 0; i < weights.length; i++) weights[i] = /** @type {number} */ (pose[joints.length + i]);
  }

  /**
   * @param {DataView<ArrayBufferLike>} view
   * @param {boolean} key
   * @param {number} joints
   * @param {number} weights
   */
  #take_apart(view, key, joints, weights) {
    require_payload(view.byteLength > 0, () => "expected a pose as q16 of a byte or more, found none");
    const present = view.getUint8(0);
    require_payload(present < 16, () => `expected sections below 16, found ${present}`);
    const record_bytes = [
      this.#translations.record_bytes(key), kRotationBytes, this.#scales.record_bytes(key), this.#weights.record_bytes(key),
    ];
    let at = 1;
    for (const [s, section] of this.#sections.entries()) {
      section.count = 0;
      if (((present >> s) & 1) === 0) continue;
      const elements = s === 3 ? weights : joints;
      section.bitmap = at;
      at = end_of(view, at, Math.ceil(elements / 8), s);
      section.count = count_bits(view, section.bitmap, elements);
      section.records = at;
      at = end_of(view, at, section.count * /** @type {number} */ (record_bytes[s]), s);
    }
    require_payload(at === view.byteLength, () => `expected the end of a pose as q16, found ${view.byteLength - at} bytes`);
  }

  /**
   * @param {number} joints
   * @param {number} weights
   */
  #rest(joints, weights) {
    this.#translations.reset(joints);
    this.#scales.reset(joints);
    this.#weights.reset(weights);
    this.#joints = joints;
    const size = joints * kFloatsPerJoint + weights;
    if (this.#pose.length !== size) this.#pose = new Float32Array(size);
    this.#pose.fill(0);
    for (let i = 0; i < joints * kFloatsPerJoint; i += kFloatsPerJoint) this.#pose.fill(1, i + kRotationAt + 3, i + kFloatsPerJoint);
  }
}

function new_section() {
  return { bitmap: 0, records: 0, count: 0 };
}

/**
 * @param {DataView<ArrayBufferLike>} view
 * @param {number} at
 * @param {number} bytes
 * @param {number} section
 * @returns {number} where what begins at `at` ends
 */
function end_of(view, at, bytes, section) {
  require_payload(
    at + bytes <= view.byteLength,
    () => `expected ${bytes} bytes of section ${section} of a pose as q16, found ${view.byteLength - at}`,
  );
  return at + bytes;
}

/**
 * @param {DataView<ArrayBufferLike>} view
 * @param {number} bitmap
 * @param {number} element
 */
function bit(view, bitmap, element) {
  return ((view.getUint8(bitmap + (element >> 3)) >> (element & 7)) & 1) !== 0;
}

/**
 * @param {DataView<ArrayBufferLike>} view
 * @param {number} bitmap
 * @param {number} elements
 */
function count_bits(view, bitmap, elements) {
  let count = 0;
  for (let e = 0; e < Math.ceil(elements / 8) * 8; e++) {
    if (!bit(view, bitmap, e)) continue;
    require_payload(e < elements, () => `expected a bitmap of ${elements} elements, found bits beyond`);
    count++;
  }
  return count;
}

/**
 * @param {DataView<ArrayBufferLike>} view
 * @param {Section} section
 */
function check_rotations(view, section) {
  for (let i = 0, at = section.records; i < section.count; i++, at += kRotationBytes) {
    let square = 0;
    for (let w = 0; w < 3; w++) square += small_step(view, at, w) ** 2;
    const spare = view.getUint16(at + 4, true) >> 15;
    require_payload(spare === 0 && square <= 2 * kMostSteps ** 2, () => `expected a rotation, found none at record ${i}`);
  }
}

/**
 * @param {DataView<ArrayBufferLike>} view
 * @param {number} at    of a rotation
 * @param {number} word  0 to 2
 */
function small_step(view, at, word) {
  return (view.getUint16(at + 2 * word, true) & 0x7fff) - 16384;
}

/**
 * Of xyzw the one of largest magnitude is left out, and positive.
 * @param {DataView<ArrayBufferLike>} view
 * @param {Section} section
 * @param {number} joints
 * @param {Float32Array} pose
 */
function read_rotations(view, section, joints, pose) {
  if (section.count === 0) return;
  let at = section.records;
  for (let j = 0; j < joints; j++) {
    if (!bit(view, section.bitmap, j)) continue;
    const largest = (view.getUint16(at, true) >> 15) | ((view.getUint16(at + 2, true) >> 15) << 1);
    const first = j * kFloatsPerJoint + kRotationAt;
    let rest = 1;
    for (let i = 0, word = 0; i < 4; i++) {
      if (i === largest) continue;
      const value = small_step(view, at, word++) / kPerUnit;
      pose[first + i] = value;
      rest -= value * value;
    }
    pose[first + largest] = Math.sqrt(Math.max(rest, 0));
    at += kRotationBytes;
  }
}
