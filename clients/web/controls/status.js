/**
 * The connection, the pictures' rate and age, and what lies over the picture when there is nothing to see.
 *
 * @import {Connection, ConnectionState} from "../connection.js"
 * @import {StageStore} from "../stage_state.js"
 * @import {FrameMeter} from "../frame_meter.js"
 */
import { element, set_text } from "../dom.js";
import { lead_player } from "../stage_state.js";

const kReadEvery_ms = 500;

/**
 * @param {ConnectionState} state
 * @returns {{label: string, note: string}} for the badge, and at length over the picture ("": it is all right)
 */
export function connection_words({ phase, reason, retry_ms }) {
  switch (phase) {
    case "open":
      return { label: "Connected", note: "" };
    case "connecting":
      return reason
        ? { label: "Reconnecting", note: `Connection lost: ${reason}. Trying again now …` }
        : { label: "Connecting", note: "Connecting to the server …" };
    case "waiting":
      return {
        label: "Reconnecting",
        note: `Connection lost: ${reason}. Trying again in ${(retry_ms / 1000).toFixed(1)} s.`,
      };
    case "refused":
      return { label: "Refused", note: `The server refuses this page: ${reason}` };
    case "stopped":
      return { label: "Stopped", note: "The connection is closed." };
  }
}

/**
 * @param {Connection} connection
 * @param {StageStore} store
 */
export function show_connection(connection, store) {
  const badge = element("connection", HTMLElement);
  const note = element("note", HTMLElement);
  const text = element("note_text", HTMLElement);
  const retry = element("retry", HTMLButtonElement);
  const controls = element("controls", HTMLFieldSetElement);
  const scene = element("scene_name", HTMLElement);
  retry.addEventListener("click", () => connection.start());

  const write = () => {
    const words = connection_words(connection.state);
    const { phase } = connection.state;
    const { state } = store;
    badge.dataset["phase"] = phase;
    set_text(badge, words.label);
    const empty = state.connected && state.revision > 0 && state.actors.length === 0;
    const shown = words.note || (empty ? "This scene has no actors yet." : "");
    set_text(text, shown);
    note.hidden = shown === "";
    retry.hidden = phase !== "waiting" && phase !== "refused";
    controls.disabled = !state.connected || !state.can_control || lead_player(state) === null;
    set_text(scene, state.scene);
  };
  connection.states.add(write);
  store.subscribe(write);
  write();
}

/**
 * @param {FrameMeter} meter
 * @param {HTMLCanvasElement} canvas
 */
export function show_meter(meter, canvas) {
  const node = element("meter", HTMLElement);
  setInterval(() => {
    const { per_second, age_ms } = meter.read(performance.now());
    if (per_second === 0) {
      set_text(node, meter.ever ? "still" : "no picture"); // nothing changes, so nothing is sent
      return;
    }
    const age = age_ms === null ? "" : ` · ${age_ms.toFixed(age_ms < 10 ? 1 : 0)} ms old`;
    set_text(node, `${per_second} fps${age} · ${canvas.width} × ${canvas.height}`);
  }, kReadEvery_ms);
}
