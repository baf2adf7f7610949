/**
 * What a player's media time is at a reading of the server's clock: the server's own rule (docs/PROTOCOL.md, section 3),
 * so that the scrubber moves between packets without asking. Pure.
 *
 * @import {PlayerMessage} from "./protocol_types.js"
 */

/**
 * @typedef {object} PlayerAnchorFields
 * @property {number} at_us       the reading at which `time` held
 * @property {boolean} returning  on a ping-pong's way back
 *
 * @typedef {PlayerMessage & PlayerAnchorFields} Player  a player whose time is known at one reading
 */

/**
 * @param {number} value
 * @param {number} length
 */
const modulo = (value, length) => ((value % length) + length) % length;

/**
 * @param {Player} player
 * @param {number | null} now_us  null: nobody knows, so nothing has moved
 * @returns {number} media seconds
 */
export function time_at(player, now_us) {
  const [start, end] = player.range;
  const length = end - start;
  if (!player.playing || now_us === null || !(length > 0)) return player.time;
  // A player is never shown before the reading that it was told at: clocks agree to a fraction of a millisecond only.
  const elapsed_s = Math.max(0, now_us - player.at_us) / 1e6;
  const way = player.returning ? -player.speed : player.speed;
  const unfolded = player.time - start + way * elapsed_s;
  if (player.loop === "once") return start + Math.min(Math.max(unfolded, 0), length);
  if (player.loop === "repeat") return start + modulo(unfolded, length);
  const folded = modulo(unfolded, 2 * length);
  return start + (folded > length ? 2 * length - folded : folded);
}

/**
 * The player after a reading of its time from a packet. Which way a ping-pong goes is not told; two readings show it.
 * @param {Player} player
 * @param {number} time
 * @param {number} at_us
 * @param {boolean} jumped  a seek, an edit or another break lies between: the two readings say nothing about direction
 * @returns {Player}
 */
export function anchored(player, time, at_us, jumped) {
  if (at_us < player.at_us) return player; // a packet from before what we know
  const moved = (time - player.time) * Math.sign(player.speed);
  const tells = player.loop === "ping_pong" && player.playing && !jumped && moved !== 0;
  return { ...player, time, at_us, returning: tells ? moved < 0 : player.returning };
}
