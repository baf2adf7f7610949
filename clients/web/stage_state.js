/**
 * What the page knows of the scene, as told by the server, and who is selected: the one thing that views read. Changed by
 * `reduce` alone.
 *
 * @import {ActorMessage, CameraMessage, MarkerMessage, PlayersMessage, SceneMessage} from "./protocol_types.js"
 * @import {Player} from "./player_time.js"
 */
import { Listeners } from "./listeners.js";
import { anchored, time_at } from "./player_time.js";

/**
 * @typedef {object} StageState
 * @property {string} scene
 * @property {boolean} connected  false: all below is what was true last
 * @property {boolean} can_control  what the role allows
 * @property {number} revision
 * @property {ActorMessage[]} actors
 * @property {Record<string, Player>} players  by actor
 * @property {CameraMessage | null} camera  the scene's
 * @property {string | null} selected  an actor; null: all of them
 * @property {number} fade_s  what a change of clip takes
 * @property {{actor: string, clip: string, list: MarkerMessage[]} | null} markers  of one clip, once they are known
 * @property {{actor: string, clip: string, marker: number} | null} crossed  the last marker that was; each its own object
 *
 * @typedef {{type: "connected", can_control: boolean}
 *   | {type: "disconnected", now_us: number | null}
 *   | {type: "described", scene: SceneMessage}
 *   | ({type: "players"} & PlayersMessage)
 *   | {type: "ended", actor: string, clip: string}
 *   | {type: "reading", actor: string | null, time: number, server_us: number, jumped: boolean}
 *   | {type: "selected", actor: string | null}
 *   | {type: "fade", seconds: number}
 *   | {type: "markers", actor: string, clip: string, list: MarkerMessage[]}
 *   | {type: "crossed", actor: string, clip: string, marker: number}} StageChange
 */

/**
 * @param {string} scene
 * @returns {StageState}
 */
export function initial_state(scene) {
  return {
    scene,
    connected: false,
    can_control: false,
    revision: 0,
    actors: [],
    players: {},
    camera: null,
    selected: null,
    fade_s: 0.3,
    markers: null,
    crossed: null,
  };
}

/**
 * The actor whose time the page shows: the selected one, else the first, which also gives the packets their media time.
 * @param {StageState} state
 * @returns {Player | null}
 */
export function lead_player(state) {
  const name = state.selected ?? state.actors[0]?.actor;
  return (name !== undefined && state.players[name]) || null;
}

/**
 * The markers of what the lead player plays; none while they are not known.
 * @param {StageState} state
 * @returns {MarkerMessage[]}
 */
export function lead_markers(state) {
  const lead = lead_player(state);
  const known = state.markers;
  return lead && known && known.actor === lead.actor && known.clip === lead.clip ? known.list : [];
}

/**
 * Those that a command from here concerns.
 * @param {StageState} state
 * @returns {Player[]}
 */
export function selected_players(state) {
  return state.actors
    .filter((a) => state.selected === null || a.actor === state.selected)
    .flatMap((a) => state.players[a.actor] ?? []);
}

/**
 * @param {StageState} state
 * @param {PlayersMessage} message
 * @returns {Record<string, Player>}
 */
function with_players(state, { players, server_time_us }) {
  const all = { ...state.players };
  for (const told of players) {
    const known = all[told.actor];
    // Answers and events cross: what is older than what we know is no news.
    if (known && known.at_us > server_time_us) continue;
    const same_way = known && known.loop === told.loop && known.clip === told.clip;
    all[told.actor] = { ...told, at_us: server_time_us, returning: same_way ? known.returning : false };
  }
  return all;
}

/**
 * @param {StageState} state
 * @param {SceneMessage} scene
 * @returns {StageState}
 */
function described(state, scene) {
  const names = new Set(scene.actors.map((a) => a.actor));
  return {
    ...state,
    revision: scene.revision,
    actors: scene.actors,
    camera: scene.camera,
    players: Object.fromEntries(Object.entries(state.players).filter(([name]) => names.has(name))),
    selected: state.selected !== null && names.has(state.selected) ? state.selected : null,
  };
}

/**
 * @param {StageState} state
 * @param {string} actor
 * @param {string} clip
 * @returns {StageState}
 */
function ended(state, actor, clip) {
  const player = state.players[actor];
  if (!player || player.clip !== clip) return state;
  const time = player.speed < 0 ? player.range[0] : player.range[1];
  return { ...state, players: { ...state.players, [actor]: { ...player, playing: false, time } } };
}

/**
 * @param {StageState} state
 * @param {{actor: string | null, time: number, server_us: number, jumped: boolean}} reading
 * @returns {StageState}
 */
function read(state, { actor, time, server_us, jumped }) {
  const name = actor ?? state.actors[0]?.actor ?? "";
  const player = state.players[name];
  if (!player) return state;
  const next = anchored(player, time, server_us, jumped);
  return next === player ? state : { ...state, players: { ...state.players, [name]: next } };
}

/**
 * @param {StageState} state
 * @param {StageChange} change
 * @returns {StageState} the same object, if nothing has changed
 */
export function reduce(state, change) {
  switch (change.type) {
    case "connected":
      return { ...state, connected: true, can_control: change.can_control };
    case "disconnected":
      return { ...state, connected: false, players: frozen(state.players, change.now_us) };
    case "described":
      return described(state, change.scene);
    case "players":
      return { ...state, players: with_players(state, change) };
    case "ended":
      return ended(state, change.actor, change.clip);
    case "reading": // of a packet (actor null: packets of frames carry the first actor's time) or asked for
      return read(state, change);
    case "selected":
      return { ...state, selected: change.actor };
    case "fade":
      return { ...state, fade_s: change.seconds };
    case "markers":
      return { ...state, markers: { actor: change.actor, clip: change.clip, list: change.list } };
    case "crossed":
      return { ...state, crossed: { actor: change.actor, clip: change.clip, marker: change.marker } };
  }
}

/**
 * Nobody is there to say that time goes on. The next server's clock may be another, and whatever it says is news.
 * @param {Record<string, Player>} players
 * @param {number | null} now_us
 * @returns {Record<string, Player>}
 */
function frozen(players, now_us) {
  return Object.fromEntries(
    Object.entries(players).map(([name, p]) => [
      name,
      { ...p, time: time_at(p, now_us), playing: false, at_us: -Infinity },
    ]),
  );
}

/** The state, and who wants to know of its changes. */
export class StageStore {
  #state;
  /** @type {Listeners<StageState>} */
  #listeners = new Listeners();

  /** @param {string} scene */
  constructor(scene) {
    this.#state = initial_state(scene);
  }

  get state() {
    return this.#state;
  }

  /** @param {StageChange} change */
  dispatch(change) {
    const next = reduce(this.#state, change);
    if (next === this.#state) return;
    this.#state = next;
    this.#listeners.tell(next);
  }

  /**
   * @param {(state: StageState) => void} listener  told at once, then of every change
   * @returns {() => void} ends it
   */
  subscribe(listener) {
    listener(this.#state);
    return this.#listeners.add(listener);
  }
}
