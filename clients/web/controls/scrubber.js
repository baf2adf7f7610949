/**
 * The time line: shows the time of the lead player, and seeks while it is dragged.
 *
 * @import {Actions} from "../actions.js"
 * @import {StageStore} from "../stage_state.js"
 */
import { element, set_text } from "../dom.js";
import { time_at } from "../player_time.js";
import { lead_player } from "../stage_state.js";

/** @param {number} seconds */
export const time_text = (seconds) => seconds.toFixed(2);

/**
 * @param {StageStore} store
 * @param {Actions} actions
 * @param {() => number | null} server_now_us
 */
export function show_scrubber(store, actions, server_now_us) {
  const slider = element("scrubber", HTMLInputElement);
  const time = element("time", HTMLElement);
  const duration = element("duration", HTMLElement);
  let dragging = false;

  const release = () => {
    if (!dragging) return;
    dragging = false;
    actions.release();
  };
  slider.addEventListener("pointerdown", () => {
    if (slider.disabled) return;
    dragging = true;
    actions.hold();
  });
  slider.addEventListener("pointerup", release);
  slider.addEventListener("pointercancel", release);
  slider.addEventListener("blur", release);
  slider.addEventListener("input", () => {
    actions.seek(slider.valueAsNumber);
    write(slider.valueAsNumber);
  });

  /** @param {number} seconds */
  function write(seconds) {
    set_text(time, time_text(seconds));
    const spoken = `${seconds.toFixed(1)} of ${time_text(Number(slider.max))} seconds`;
    if (slider.getAttribute("aria-valuetext") !== spoken) slider.setAttribute("aria-valuetext", spoken);
    place("--at", seconds);
  }

  /**
   * @param {string} property  of the style: a share of the line
   * @param {number} seconds
   */
  function place(property, seconds) {
    const whole = Number(slider.max);
    slider.style.setProperty(property, String(whole > 0 ? Math.min(seconds / whole, 1) : 0));
  }

  store.subscribe((state) => {
    const lead = lead_player(state);
    const whole = Math.max(lead?.duration ?? 0, lead?.range[1] ?? 0);
    if (Number(slider.max) !== whole) slider.max = String(whole);
    set_text(duration, time_text(whole));
    place("--in", lead?.range[0] ?? 0);
    place("--out", lead?.range[1] ?? whole);
    move();
  });

  /** Follows the time; to be called once a frame of the screen. */
  function move() {
    const lead = lead_player(store.state);
    if (dragging || !lead) return;
    const seconds = time_at(lead, server_now_us());
    if (slider.valueAsNumber === seconds) return;
    slider.value = String(seconds);
    write(seconds);
  }
  return { move };
}
