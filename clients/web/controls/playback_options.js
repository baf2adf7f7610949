/**
 * Speed, loop and interpolation of what is selected.
 *
 * @import {Actions} from "../actions.js"
 * @import {StageState, StageStore} from "../stage_state.js"
 * @import {Interpolation, Loop} from "../protocol_types.js"
 */
import { element } from "../dom.js";
import { lead_player } from "../stage_state.js";

/** Shown where the selected actors differ. */
const kMixed = "mixed";

/**
 * @param {StageState} state
 * @returns {string} the choice that stands for it
 */
export function interpolation_choice(state) {
  const concerned = state.actors.filter((a) => state.selected === null || a.actor === state.selected);
  const modes = new Set(concerned.map((a) => a.interpolation ?? ""));
  return modes.size > 1 ? kMixed : ([...modes][0] ?? "");
}

/**
 * @param {StageStore} store
 * @param {Actions} actions
 */
export function show_playback_options(store, actions) {
  const slider = element("speed", HTMLInputElement);
  const exact = element("speed_exact", HTMLInputElement);
  const loop = element("loop", HTMLSelectElement);
  const interpolation = element("interpolation", HTMLSelectElement);
  const mixed = element("interpolation_mixed", HTMLOptionElement);

  slider.addEventListener("input", () => {
    exact.value = slider.value;
    actions.set_speed(slider.valueAsNumber);
  });
  exact.addEventListener("change", () => {
    if (Number.isFinite(exact.valueAsNumber)) actions.set_speed(exact.valueAsNumber);
    else write_speed(); // nothing that could be sent was typed
  });
  exact.addEventListener("blur", write_speed); // whatever was typed, this is what is
  element("reverse", HTMLButtonElement).addEventListener("click", () => {
    const lead = lead_player(store.state);
    if (lead) actions.set_speed(-lead.speed);
  });
  loop.addEventListener("change", () => void actions.set_loop(/** @type {Loop} */ (loop.value)));
  interpolation.addEventListener("change", async () => {
    await actions.set_interpolation(/** @type {Interpolation} */ (interpolation.value) || null);
    write_choices(store.state); // if it was refused, as it was
  });

  function write_speed() {
    const speed = lead_player(store.state)?.speed ?? 1;
    // What a hand is on follows the hand.
    if (!slider.matches(":active")) slider.value = String(speed);
    if (document.activeElement !== exact) exact.value = String(Number(speed.toFixed(3)));
  }

  /** @param {StageState} state */
  function write_choices(state) {
    const looped = lead_player(state)?.loop ?? "repeat";
    if (loop.value !== looped) loop.value = looped;
    const choice = interpolation_choice(state);
    mixed.hidden = choice !== kMixed;
    if (interpolation.value !== choice) interpolation.value = choice;
  }

  store.subscribe((state) => {
    write_speed();
    write_choices(state);
  });
}
