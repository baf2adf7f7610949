#!/usr/bin/env node
/**
 * A stand-in for `tweend serve` with the options that the page's tests give it: enough of docs/PROTOCOL.md to drive and look
 * at the page without a build. It refuses little; what the page may rely on is tested against the real server.
 */
import { readFileSync, renameSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { parseArgs } from "node:util";
import { time_at } from "../../../clients/web/player_time.js";
import { orbit_of } from "../../../clients/web/orbit.js";
import { ServerSocket } from "./web_socket_server.mjs";
import { picture } from "./fake_picture.mjs";

const { values } = parseArgs({
  args: process.argv.slice(2).filter((a) => a !== "serve"),
  options: {
    listen: { type: "string", default: "127.0.0.1:0" },
    "port-file": { type: "string" },
    assets: { type: "string", multiple: true },
    load: { type: "string", multiple: true, default: ["barb"] },
    play: { type: "boolean" },
    "no-auth": { type: "boolean" },
  },
});

const kPage = new URL("../../../clients/web/", import.meta.url).pathname;
const kTypes = { ".html": "text/html; charset=utf-8", ".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml" };
const kPolicy =
  "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; " +
  "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
const kDuration = 5 / 3;

const now_us = () => Math.round(Number(process.hrtime.bigint() / 1000n));

// --------------------------------------------------------------------------------------------------------- the document
const clip_of = (clip) => ({ clip, type: "vertex", keyframes: 5, duration: kDuration, closed: false });
const scene = {
  scene: "main",
  revision: 1,
  camera: { eye: [0, 2, 10], target: [0, 0, 0], up: [0, 1, 0], fov_y: Math.PI / 4, near: 0.1, far: 500 },
  actors: values.load.map((actor) => ({
    actor,
    source: actor,
    interpolation: null,
    visible: true,
    vertices: 78,
    triangles: 26,
    show_skeleton: false,
    joints: [],
    clips: [clip_of("default")],
  })),
};
const player_of = (actor) => ({
  actor, clip: "default", playing: Boolean(values.play), time: 0, speed: 1, loop: "repeat", range: [0, kDuration],
  duration: kDuration, at_us: now_us(), returning: false,
});
const players = values.load.map(player_of);
/** Of all clips together: {clip, marker, time, name}. */
const markers = [];

/** Brings a player to now; changes what is given. */
function change(player, changes) {
  const at_us = now_us();
  Object.assign(player, { time: time_at(player, at_us), at_us }, changes);
}

function message_of(chosen) {
  const at_us = now_us();
  const told = chosen.map(({ at_us: _, returning: __, ...p }, i) => ({ ...p, time: time_at(chosen[i], at_us) }));
  return { players: told, server_time_us: at_us };
}

// --------------------------------------------------------------------------------------------------------------- clients
class Refusal extends Error {
  constructor(code, kind, path, message) {
    super(message);
    this.error = { code, message: "refused", data: { kind, path, message } };
  }
}

const clients = new Set();
const tell = (method, params) => {
  for (const client of clients) if (client.subscribed) client.send(JSON.stringify({ jsonrpc: "2.0", method, params }));
};

class Client {
  subscribed = false;
  streams = new Map();
  next_stream = 1;

  constructor(socket) {
    this.socket = socket;
    socket.on_message = (text) => this.receive(JSON.parse(text));
    socket.on_close = () => clients.delete(this);
    clients.add(this);
  }

  send(message) {
    this.socket.send(message);
  }

  receive(request) {
    this.send(answer(request, this));
  }
}

function answer({ id, method, params }, client) {
  try {
    const handler = handlers[method];
    if (!handler) throw new Refusal(-32601, "unknown_method", "", `expected a method, found "${method}"`);
    if (params.scene && params.scene !== "main") throw new Refusal(-32001, "not_found", "params.scene", `found no scene "${params.scene}"`);
    return JSON.stringify({ jsonrpc: "2.0", id, result: handler(params, client) ?? {} });
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    return JSON.stringify({ jsonrpc: "2.0", id, error: error.error });
  }
}

const chosen = ({ actor }) => {
  const found = players.filter((p) => actor === undefined || p.actor === actor);
  if (found.length === 0) throw new Refusal(-32001, "not_found", "params.actor", `expected an actor, found "${actor}"`);
  return found;
};
const playback = (how) => (params) => {
  const found = chosen(params);
  for (const player of found) how(player, params);
  const message = message_of(found);
  tell("playback.changed", { scene: "main", ...message });
  return message;
};
const wrapped = (time) => (time >= 0 && time <= kDuration ? time : ((time % kDuration) + kDuration) % kDuration);

function update_actor({ actor, interpolation, visible, show_skeleton }) {
  const found = scene.actors.find((a) => a.actor === actor) ?? scene.actors[0];
  if (interpolation !== undefined) found.interpolation = interpolation;
  if (visible !== undefined) found.visible = visible;
  if (show_skeleton !== undefined) found.show_skeleton = show_skeleton;
}
function edited(method) {
  scene.revision += 1;
  tell("scene.changed", { scene: "main", revision: scene.revision, method });
  return { revision: scene.revision };
}

const handlers = {
  "server.hello": () => ({
    server: "tweend", version: "fake", protocol: 1, role: "admin", capabilities: ["websocket", "events", "frames:jpeg"],
  }),
  "server.ping": () => ({ time_us: now_us() }),
  "scene.describe": () => scene,
  "events.subscribe": (_, client) => void (client.subscribed = true),
  "playback.get": (params) => message_of(chosen(params)),
  "playback.play": playback((p, { clip = p.clip }) => {
    change(p, { playing: true, ...(clip === p.clip ? {} : { clip, time: 0 }) });
    if (p.loop === "once" && p.time === kDuration) p.time = 0;
  }),
  "playback.pause": playback((p) => change(p, { playing: false })),
  "playback.stop": playback((p) => change(p, { playing: false, time: 0 })),
  "playback.seek": playback((p, { time }) => change(p, { time: wrapped(time) })),
  "playback.step": playback((p, { seconds, keyframes }) => {
    change(p, { playing: false });
    const gap = kDuration / 4;
    const key = keyframes > 0 ? Math.floor(p.time / gap + 1e-6) + 1 : Math.ceil(p.time / gap - 1e-6) - 1;
    change(p, { time: wrapped(seconds === undefined ? key * gap : p.time + seconds) });
  }),
  "playback.set": playback((p, { speed, loop }) => {
    change(p, { ...(speed === undefined ? {} : { speed }), ...(loop ? { loop } : {}) });
  }),
  "actor.update": (params) => {
    update_actor(params);
    return edited("actor.update");
  },
  "edit.apply": ({ edits }) => {
    for (const edit of edits) update_actor(edit.params);
    return { ...edited("edit.apply"), results: [] };
  },
  "clip.create": ({ clip }) => {
    scene.actors[0].clips.push(clip_of(clip));
    return edited("clip.create");
  },
  "keyframe.add": () => edited("keyframe.add"),
  "marker.list": ({ clip }) => ({ markers: markers.filter((m) => m.clip === clip).map(({ clip: _, ...m }) => m) }),
  "marker.add": ({ clip, time, name }) => {
    markers.push({ clip, marker: markers.length + 1, time, name });
    return { marker: markers.length, ...edited("marker.add") };
  },
  "actor.add": ({ actor, skeleton }) => {
    const { joints } = skeleton;
    scene.actors.push({
      actor, source: "skeleton", interpolation: null, visible: true, show_skeleton: false, vertices: 0, triangles: 0, joints,
      clips: [clip_of("default")],
    });
    players.push(player_of(actor));
    return edited("actor.add");
  },
  "stream.open": ({ width, height, rate, camera }, client) => {
    const stream = client.next_stream++;
    client.streams.set(stream, { stream, width, height, camera: camera ?? null, period_us: 1e6 / rate, next_us: 0, sequence: 0 });
    return { stream, layout: { width, height, codec: "jpeg" } };
  },
  "stream.update": ({ stream, camera, rate }, client) => {
    const found = client.streams.get(stream);
    if (camera !== undefined) found.camera = camera;
    if (rate !== undefined) found.period_us = 1e6 / rate;
  },
  "stream.close": ({ stream }, client) => void client.streams.delete(stream),
};

// --------------------------------------------------------------------------------------------------------------- packets
const shown = () => JSON.stringify([players.map((p) => [p.playing, p.time]), scene.actors]);

function packet(stream, at_us) {
  const time = players.length ? time_at(players[0], at_us) : 0;
  const orbit = stream.camera?.orbit ?? orbit_of(scene.camera);
  const seen = scene.actors.some((a) => a.visible) ? orbit : { ...orbit, distance: -1 };
  // Half the size is quick enough for a script.
  const payload = picture(stream.width >> 1, stream.height >> 1, seen, time / kDuration);
  const head = Buffer.alloc(40);
  head.writeUInt32LE(0x444e5754, 0);
  head.set([1, 3, 1, 1], 4); // a frame, as png
  head.writeUInt32LE(stream.stream, 8);
  head.writeUInt32LE(stream.sequence++, 12);
  head.writeBigInt64LE(BigInt(Math.round(time * 1e6)), 16);
  head.writeBigInt64LE(BigInt(at_us), 24);
  head.writeUInt32LE(scene.revision, 32);
  head.writeUInt32LE(payload.length, 36);
  return Buffer.concat([head, payload]);
}

/** Tells of the markers that a player has passed since it was asked last; forwards only. */
function tell_crossings() {
  for (const p of players) {
    const time = time_at(p, now_us());
    const before = p.told ?? time;
    p.told = time;
    if (!p.playing) continue;
    for (const { clip, marker, name, time: at } of markers) {
      const crossed = time >= before ? before < at && at <= time : before < at || at <= time;
      if (clip !== p.clip || !crossed) continue;
      tell("marker.crossed", { scene: "main", actor: p.actor, clip, marker, name, time: at, at_us: now_us() });
    }
  }
}

function end_what_has_run_out() {
  for (const p of players) {
    const time = time_at(p, now_us());
    if (!p.playing || p.loop !== "once" || time !== (p.speed < 0 ? 0 : kDuration)) continue;
    change(p, { playing: false });
    tell("playback.ended", { scene: "main", actor: p.actor, clip: p.clip });
  }
}

setInterval(() => {
  tell_crossings();
  end_what_has_run_out();
  for (const client of clients) {
    for (const stream of client.streams.values()) {
      const at_us = now_us();
      const state = shown() + JSON.stringify([stream.camera, scene.revision]);
      const moves = players.some((p) => p.playing);
      if (at_us < stream.next_us || client.socket.waiting > 0 || (!moves && state === stream.sent)) continue;
      Object.assign(stream, { sent: state, next_us: at_us + stream.period_us });
      client.send(packet(stream, at_us));
    }
  }
}, 5);

// ------------------------------------------------------------------------------------------------------------------ HTTP
const server = createServer((request, response) => {
  const path = normalize(new URL(request.url, "http://x").pathname);
  if (path === "/rpc") {
    let body = "";
    request.on("data", (bytes) => (body += bytes));
    request.on("end", () => response.writeHead(200, { "Content-Type": "application/json" }).end(answer(JSON.parse(body), null)));
    return;
  }
  try {
    const body = readFileSync(join(kPage, path === "/" ? "index.html" : path));
    const type = kTypes[path === "/" ? ".html" : extname(path)];
    response.writeHead(200, { "Content-Type": type, "Content-Security-Policy": kPolicy, "Cache-Control": "no-cache" });
    response.end(body);
  } catch {
    response.writeHead(404).end();
  }
});
server.on("upgrade", (request, stream) => new Client(new ServerSocket(request, stream)));
process.on("SIGTERM", () => process.exit(0));

const [host, port] = values.listen.split(":");
server.listen(Number(port), host, () => {
  const bound = server.address().port;
  console.log(`http://${host}:${bound}/`);
  if (!values["port-file"]) return;
  writeFileSync(`${values["port-file"]}.new`, `${bound}\n`);
  renameSync(`${values["port-file"]}.new`, values["port-file"]);
});
