/**
 * The connection, the pictures' rate and age, and what lies over the picture when there is nothing to see.
 *
 * @import {Connection, ConnectionState} from "../connection.js"
 * @import {StageStore} from "../stage_state.js"
 * @import {FrameMeter} from "../frame_meter.js"
 * @import {Drawn} from "../frame_view.js"
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
 * @param {number} bytes
 * @returns {string} as people read it
 */
export function bytes_text(bytes) {
  return bytes < 999_500 ? `${Math.round(bytes / 1000)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}

const kBetween = " · ";
const kEncodingNames = { h264: "H.264", jpeg: "JPEG" };

/**
 * @param {ReturnType<FrameMeter["read"]>} reading
 * @param {Pick<Drawn, "layout" | "size"> | null} picture  the last one; null: none yet
 * @returns {string}
 */
export function meter_words({ per_second, age_ms, bytes_per_second }, picture) {
  if (!picture) return "no picture";
  const { layout, size } = picture;
  const smaller = size.width !== layout.width || size.height !== layout.height;
  const found = `${size.width} × ${size.height}${smaller ? ` of ${layout.width} × ${layout.height}` : ""}`;
  const what = [found, kEncodingNames[layout.encoding]];
  if (per_second === 0) return ["still", ...what].join(kBetween); // nothing changes, so nothing is sent
  const age = age_ms === null ? [] : [`${age_ms.toFixed(age_ms < 10 ? 1 : 0)} ms old`];
  return [`${per_second} fps`, ...age, ...what, `${bytes_text(bytes_per_second)}/s`].join(kBetween);
}

/**
 * Sets a text of parts; where it needs a second line, it breaks between them only.
 * @param {HTMLElement} node
 * @param {string} text
 */
function set_parts(node, text) {
  if (node.textContent === text) return;
  const parts = text.split(kBetween).map((part) => {
    const span = document.createElement("span");
    span.textContent = part;
    return [span, kBetween];
  });
  node.replaceChildren(...parts.flat().slice(0, -1));
}

/**
 * @param {FrameMeter} meter
 * @param {() => Drawn | null} picture
 */
export function show_meter(meter, picture) {
  const node = element("meter", HTMLElement);
  setInterval(() => set_parts(node, meter_words(meter.read(performance.now()), picture())), kReadEvery_ms);
}
