/**
 * The markers of the lead player's clip: ticks under the line of time, which light up as they are passed.
 *
 * @import {StageStore} from "../stage_state.js"
 * @import {MarkerMessage} from "../protocol_types.js"
 */
import { element } from "../dom.js";
import { lead_markers, lead_player } from "../stage_state.js";

/**
 * @param {MarkerMessage[]} markers
 * @param {number} whole  what the line of time spans, seconds
 * @returns {MarkerMessage[]} those that lie on it
 */
export const markers_on_line = (markers, whole) => markers.filter(({ time }) => whole > 0 && time <= whole);

/** @param {StageStore} store */
export function show_marker_ticks(store) {
  const list = element("markers", HTMLElement);
  /** @type {Map<number, HTMLElement>} by the marker's id */
  const ticks = new Map();

  /** @param {MarkerMessage} marker @param {number} whole */
  function tick({ marker, time, name }, whole) {
    const node = Object.assign(document.createElement("span"), { className: "marker", title: name });
    node.dataset["name"] = name;
    node.style.setProperty("--at", String(time / whole));
    ticks.set(marker, node);
    return node;
  }

  /** @type {unknown[]} what the ticks were made of */
  let made_of = [];
  /** @type {unknown} */
  let lit = null;
  store.subscribe((state) => {
    const lead = lead_player(state);
    const whole = Math.max(lead?.duration ?? 0, lead?.range[1] ?? 0);
    const markers = lead_markers(state);
    if (made_of[0] !== state.markers || made_of[1] !== lead?.actor || made_of[2] !== lead?.clip || made_of[3] !== whole) {
      made_of = [state.markers, lead?.actor, lead?.clip, whole];
      ticks.clear();
      list.replaceChildren(...markers_on_line(markers, whole).map((marker) => tick(marker, whole)));
    }
    const { crossed } = state;
    if (crossed === lit) return;
    lit = crossed;
    if (!crossed || crossed.actor !== lead?.actor || crossed.clip !== lead.clip) return;
    flash(ticks.get(crossed.marker));
  });
}

/** @param {HTMLElement | undefined} node */
function flash(node) {
  if (!node) return;
  node.getAnimations().forEach((animation) => animation.cancel()); // a quick loop lights it anew
  node.animate([{ background: "var(--accent)", scale: "1.6" }, { background: "var(--soft)", scale: "1" }], {
    duration: 400,
    easing: "ease-out",
  });
}
