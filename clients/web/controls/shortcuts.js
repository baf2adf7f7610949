/**
 * The keyboard. Keys belong to whoever has the focus first: typing is typing, and Space on a button presses it.
 *
 * @import {Actions} from "../actions.js"
 * @import {ViewCamera} from "../view_camera.js"
 */

const kStep_s = 0.1;
const kTurn_px = 24;
const kZoom = 1.1;

/**
 * Whether an element takes this key for itself.
 * @param {{tagName: string, type?: string, id?: string}} target
 * @param {string} key
 */
export function belongs_to(target, key) {
  if (target.id === "scrubber") return false; // our arrows move the time as its own would, only by a known step
  if (target.tagName === "BUTTON" || target.tagName === "SUMMARY") return key === " " || key === "Enter";
  if (target.tagName === "INPUT" && target.type === "radio") return key === " " || key.startsWith("Arrow");
  return ["INPUT", "SELECT", "TEXTAREA"].includes(target.tagName);
}

/**
 * @param {Actions} actions
 * @param {ViewCamera} camera
 * @param {() => number} picture_height  CSS pixels
 */
export function listen_to_keys(actions, camera, picture_height) {
  /** @param {number} dx @param {number} dy */
  const turn = (dx, dy) => camera.turn(dx * kTurn_px, dy * kTurn_px, picture_height());
  /** @type {Record<string, (shift: boolean) => unknown>} */
  const keys = {
    " ": () => actions.toggle_play(),
    Home: () => actions.stop(),
    ArrowLeft: (shift) => (shift ? actions.step_keyframes(-1) : actions.step_seconds(-kStep_s)),
    ArrowRight: (shift) => (shift ? actions.step_keyframes(1) : actions.step_seconds(kStep_s)),
    f: () => camera.reset(),
    a: () => turn(-1, 0),
    d: () => turn(1, 0),
    w: () => turn(0, -1),
    s: () => turn(0, 1),
    "+": () => camera.zoom(1 / kZoom),
    "-": () => camera.zoom(kZoom),
  };
  addEventListener("keydown", (event) => {
    const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    const target = event.target instanceof HTMLElement ? event.target : document.body;
    if (!action || event.ctrlKey || event.altKey || event.metaKey || belongs_to(target, event.key)) return;
    event.preventDefault(); // no scrolling
    if (event.key === " " && event.repeat) return; // held down, it would flicker
    action(event.shiftKey);
  });
}
