/**
 * Which clip an actor plays: a choice in its row of the list, where there is more than one.
 *
 * @import {Actions} from "../actions.js"
 * @import {StageState, StageStore} from "../stage_state.js"
 * @import {ActorMessage} from "../protocol_types.js"
 */
import { element } from "../dom.js";

/**
 * @param {ActorMessage} actor
 * @param {StageStore} store
 * @param {Actions} actions
 */
export function clip_picker({ actor, clips }, store, actions) {
  const select = document.createElement("select");
  select.dataset["key"] = `clip:${actor}`;
  select.dataset["actor"] = actor;
  select.setAttribute("aria-label", `Clip of ${actor}`);
  select.title = "Which clip is played";
  select.append(...clips.map(({ clip }) => new Option(clip, clip)));
  select.addEventListener("change", async () => {
    await actions.play_clip(actor, select.value);
    write(select, store.state); // if it was refused, as it was
  });
  return select;
}

/**
 * @param {HTMLSelectElement} select
 * @param {StageState} state
 */
function write(select, state) {
  const clip = state.players[select.dataset["actor"] ?? ""]?.clip;
  if (clip !== undefined && select.value !== clip) select.value = clip;
}

/**
 * @param {HTMLElement} list
 * @param {StageState} state
 */
export function show_current_clips(list, state) {
  for (const select of list.querySelectorAll("select")) write(select, state);
}

/**
 * How long a change of clip takes: there where any actor has a choice.
 * @param {StageStore} store
 * @param {Actions} actions
 */
export function show_fade(store, actions) {
  const field = element("fade", HTMLInputElement);
  const whole = element("fade_field", HTMLElement);
  const label = element("fade_label", HTMLElement);
  field.addEventListener("change", () => {
    if (field.valueAsNumber >= 0) actions.set_fade(field.valueAsNumber);
    field.value = String(store.state.fade_s);
  });
  store.subscribe(({ actors }) => {
    const any = actors.some((a) => a.clips.length > 1);
    whole.hidden = label.hidden = !any;
  });
}
