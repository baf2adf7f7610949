/**
 * The actors: which one the controls concern, and which are shown.
 *
 * @import {Actions} from "../actions.js"
 * @import {StageStore} from "../stage_state.js"
 * @import {ActorMessage} from "../protocol_types.js"
 */
import { element, icon } from "../dom.js";
import { clip_picker, show_current_clips } from "./clip_picker.js";

/**
 * @param {ActorMessage} actor
 * @returns {string} what it is, in a few words
 */
export function actor_detail({ clips, vertices }) {
  const keyframes = clips.reduce((sum, c) => sum + c.keyframes, 0);
  /** @param {number} n @param {string} what */
  const count = (n, what) => `${n.toLocaleString("en")} ${what}${n === 1 ? "" : "s"}`;
  const mesh = vertices === 1 ? "1 vertex" : `${vertices.toLocaleString("en")} vertices`;
  const parts = clips.length > 1 ? [count(clips.length, "clip")] : [];
  return [...parts, count(keyframes, "keyframe"), mesh].join(" · ");
}

/**
 * @param {StageStore} store
 * @param {Actions} actions
 */
export function show_actor_list(store, actions) {
  const list = element("actors", HTMLUListElement);

  /**
   * @param {string | null} name  null: all
   * @param {string} title
   * @param {string} detail
   * @param {boolean} chosen
   */
  function choice(name, title, detail, chosen) {
    const radio = Object.assign(document.createElement("input"), { type: "radio", name: "actor", checked: chosen });
    radio.value = name ?? "";
    radio.dataset["key"] = `radio:${name ?? ""}`;
    radio.addEventListener("change", () => actions.select(name));
    const text = Object.assign(document.createElement("span"), { className: "actor_name", textContent: title });
    const more = Object.assign(document.createElement("span"), { className: "actor_detail", textContent: detail });
    const label = document.createElement("label");
    label.append(radio, text, more);
    return label;
  }

  /** @param {ActorMessage} actor */
  function eye({ actor, visible }) {
    const button = Object.assign(document.createElement("button"), { type: "button", className: "quiet square" });
    button.dataset["key"] = `eye:${actor}`;
    button.setAttribute("aria-pressed", String(visible));
    button.setAttribute("aria-label", `Show ${actor}`);
    button.title = visible ? `Hide ${actor}` : `Show ${actor}`;
    button.append(icon(visible ? "eye" : "eye-off"));
    button.addEventListener("click", () => void actions.set_visible(actor, !visible));
    return button;
  }

  /** @param {ActorMessage} actor */
  function bones({ actor, show_skeleton }) {
    const button = Object.assign(document.createElement("button"), { type: "button", className: "quiet square bones" });
    button.dataset["key"] = `bones:${actor}`;
    button.setAttribute("aria-pressed", String(show_skeleton));
    button.setAttribute("aria-label", `Show the skeleton of ${actor}`);
    button.title = `${show_skeleton ? "Hide" : "Show"} the skeleton`;
    button.append(icon("bone"));
    button.addEventListener("click", () => void actions.set_skeleton(actor, !show_skeleton));
    return button;
  }

  /** @type {unknown[]} what the list was made of */
  let made_of = [];
  store.subscribe((state) => {
    if (made_of[0] === state.actors && made_of[1] === state.selected) {
      show_current_clips(list, state); // players change far more often
      return;
    }
    made_of = [state.actors, state.selected];
    const focused = document.activeElement instanceof HTMLElement ? document.activeElement.dataset["key"] : undefined;
    const rows = state.actors.map((actor) => {
      const row = document.createElement("li");
      row.classList.toggle("hidden_actor", !actor.visible);
      row.append(choice(actor.actor, actor.actor, actor_detail(actor), state.selected === actor.actor));
      if (actor.clips.length > 1) row.append(clip_picker(actor, store, actions));
      if (actor.joints.length > 0) row.append(bones(actor));
      row.append(eye(actor));
      return row;
    });
    const all = document.createElement("li");
    all.append(choice(null, "All", state.actors.length === 1 ? "1 actor" : `${state.actors.length} actors`, state.selected === null));
    list.replaceChildren(all, ...rows);
    show_current_clips(list, state);
    // Made anew, but not under the feet of who was there.
    if (focused) /** @type {HTMLElement | null} */ (list.querySelector(`[data-key="${CSS.escape(focused)}"]`))?.focus();
  });
}
