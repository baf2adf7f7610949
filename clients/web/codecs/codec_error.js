/** A payload that is not what its packet's header says, or that lacks its predecessor. */
export class CodecError extends Error {}

/**
 * @param {boolean} holds
 * @param {() => string} say  what was expected and what was found
 * @returns {asserts holds}
 */
export function require_payload(holds, say) {
  if (!holds) throw new CodecError(say());
}
