/**
 * One line for what went wrong: it takes nothing away from whoever is working, and goes by itself.
 */
import { ConnectionLost, RpcError } from "../connection.js";
import { element } from "../dom.js";

const kShown_ms = 10000;

/**
 * @param {unknown} error
 * @returns {string} for a person; "" for what the connection's state says already
 */
export function error_text(error) {
  if (error instanceof ConnectionLost) return "";
  if (error instanceof RpcError) return `${error.method}: ${error.message}${error.path ? ` (${error.path})` : ""}`;
  return error instanceof Error ? error.message : String(error);
}

/** @returns {(error: unknown) => void} shows it */
export function show_messages() {
  const line = element("message", HTMLElement);
  const text = element("message_text", HTMLElement);
  let timer = 0;
  const hide = () => {
    line.hidden = true;
    text.textContent = "";
  };
  element("message_close", HTMLButtonElement).addEventListener("click", hide);
  return (error) => {
    const words = error_text(error);
    if (!words) return;
    text.textContent = words;
    line.hidden = false;
    clearTimeout(timer);
    timer = setTimeout(hide, kShown_ms);
  };
}
