/**
 * How the picture is sent: a viewer's own choice, so whoever may only watch has it too.
 *
 * @import {EncodingChoice, EncodingWish} from "../encoding_choice.js"
 */
import { element, set_text } from "../dom.js";

/** @param {EncodingChoice} choice */
export function show_encoding_picker(choice) {
  const select = element("encoding", HTMLSelectElement);
  const auto = element("encoding_auto", HTMLOptionElement);
  const video = element("encoding_h264", HTMLOptionElement);
  select.addEventListener("change", () => choice.choose(/** @type {EncodingWish} */ (select.value)));
  const write = () => {
    const why_not = choice.why_not_h264;
    video.disabled = why_not !== "";
    set_text(video, why_not ? `H.264 (${why_not})` : "H.264");
    set_text(auto, choice.trouble ? `Auto: JPEG (${choice.trouble})` : "Auto");
    select.title = `How the picture is sent${choice.trouble && `: as JPEG (${choice.trouble})`}`;
    select.value = choice.wish;
  };
  choice.updates.add(write);
  write();
}
