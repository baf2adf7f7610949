/**
 * Play or pause, stop, and the steps between.
 *
 * @import {Actions} from "../actions.js"
 * @import {StageStore} from "../stage_state.js"
 */
import { element, icon } from "../dom.js";
import { selected_players } from "../stage_state.js";

/**
 * @param {StageStore} store
 * @param {Actions} actions
 */
export function show_transport(store, actions) {
  const play = element("play", HTMLButtonElement);
  play.addEventListener("click", () => void actions.toggle_play());
  element("stop", HTMLButtonElement).addEventListener("click", () => void actions.stop());
  element("previous", HTMLButtonElement).addEventListener("click", () => void actions.step_keyframes(-1));
  element("next", HTMLButtonElement).addEventListener("click", () => void actions.step_keyframes(1));

  /** @type {boolean | null} */
  let shown = null;
  store.subscribe((state) => {
    const playing = selected_players(state).some((p) => p.playing);
    if (playing === shown) return;
    shown = playing;
    play.replaceChildren(icon(playing ? "pause" : "play"));
    play.setAttribute("aria-label", playing ? "Pause" : "Play");
    play.title = `${playing ? "Pause" : "Play"} (Space)`;
  });
}
