/**
 * Wires the parts: what is told flows from the connection into the store and on to the views, what is asked from the views
 * through actions to the connection.
 *
 * @import {Drawn} from "./frame_view.js"
 */
import { make_actions } from "./actions.js";
import { ServerClock } from "./clock.js";
import { Connection } from "./connection.js";
import { show_actor_list } from "./controls/actor_list.js";
import { show_fade } from "./controls/clip_picker.js";
import { show_encoding_picker } from "./controls/encoding_picker.js";
import { show_marker_ticks } from "./controls/marker_ticks.js";
import { error_text, show_messages } from "./controls/messages.js";
import { show_playback_options } from "./controls/playback_options.js";
import { show_scrubber } from "./controls/scrubber.js";
import { listen_to_keys } from "./controls/shortcuts.js";
import { show_connection, show_meter } from "./controls/status.js";
import { show_transport } from "./controls/transport.js";
import { element } from "./dom.js";
import { EncodingChoice, obstacle_to_h264 } from "./encoding_choice.js";
import { FrameMeter } from "./frame_meter.js";
import { FrameStream } from "./frame_stream.js";
import { FrameView } from "./frame_view.js";
import { GapWatch } from "./gap_watch.js";
import { listen_to_gestures } from "./gestures.js";
import { StageSession } from "./stage_session.js";
import { StageStore } from "./stage_state.js";
import { ViewCamera } from "./view_camera.js";

const scene = new URLSearchParams(location.search).get("scene") || "main";
const token = new URLSearchParams(location.hash.slice(1)).get("token") || undefined;
const url = new URL("/ws", location.href);
url.protocol = location.protocol === "https:" ? "wss:" : "ws:";
url.hash = "";

const report = show_messages();
const clock = new ServerClock();
const store = new StageStore(scene);
const connection = new Connection({ url: url.href, client: "web", ...(token ? { token } : {}) });
const encodings = new EncodingChoice();
connection.states.add((state) => encodings.follow(state));
const stream = new FrameStream(connection, scene, report);
const session = new StageSession(connection, store, clock, report);
const actions = make_actions(connection, store, report);
const camera = new ViewCamera();
const meter = new FrameMeter();
const gaps = new GapWatch();
const canvas = element("picture", HTMLCanvasElement);
const view = new FrameView(canvas, report);

/** @type {Drawn | null} */
let last_drawn = null;

stream.opened.add((layout) => {
  gaps.begin();
  view.begin(layout);
});
stream.closed.add(() => view.end());
stream.packets.add((packet) => {
  store.dispatch({
    type: "reading",
    actor: null,
    time: packet.media_s,
    server_us: packet.server_us,
    jumped: packet.discontinuity,
  });
  meter.receive(performance.now(), packet.payload.length);
  view.push(packet);
  if (gaps.receive(performance.now(), packet.sequence)) encodings.too_slow();
});
view.drawn.add((drawn) => {
  last_drawn = drawn;
  const now_us = clock.now_us();
  meter.add(performance.now(), now_us === null ? null : (now_us - drawn.packet.server_us) / 1000);
});
view.keys_needed.add(() => stream.request_key());

/** @param {unknown} error */
const without_h264 = (error) => {
  encodings.give_up();
  report(new Error(`H.264 can't be played, so JPEG is: ${error_text(error)}`));
};
stream.refusals.add(without_h264);
view.failures.add(without_h264);
encodings.changes.add((encoding) => stream.set_encoding(encoding));
view.sizes.add((size) => stream.set_size(size));
camera.changes.add((own) => stream.set_camera(own));
store.subscribe((state) => camera.follow(state.camera));

const height = () => view.css_height;
listen_to_gestures(canvas, {
  turn: (dx, dy) => camera.turn(dx, dy, height()),
  pan: (dx, dy) => camera.pan(dx, dy, height()),
  zoom: (factor) => camera.zoom(factor),
});
listen_to_keys(actions, camera, height);

const fit = element("fit", HTMLButtonElement);
fit.addEventListener("click", () => camera.reset());
camera.changes.add((own) => (fit.disabled = own === null));

show_connection(connection, store);
show_encoding_picker(encodings);
show_meter(meter, () => last_drawn);
show_transport(store, actions);
show_playback_options(store, actions);
show_fade(store, actions);
show_actor_list(store, actions);
show_marker_ticks(store);
const scrubber = show_scrubber(store, actions, () => clock.now_us());

const each_frame = () => {
  scrubber.move();
  requestAnimationFrame(each_frame);
};
requestAnimationFrame(each_frame);

const watched = () => stream.set_watched(document.visibilityState === "visible");
document.addEventListener("visibilitychange", watched);
addEventListener("online", () => connection.start());
addEventListener("hashchange", () => location.reload()); // another token

watched();
view.start();
session.start();
connection.start();
void obstacle_to_h264().then((obstacle) => encodings.set_obstacle(obstacle));
