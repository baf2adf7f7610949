/**
 * Keeps the store true to the server: asks when the connection opens, listens to events from then on, and keeps the clock.
 *
 * @import {Connection} from "./connection.js"
 * @import {ServerClock} from "./clock.js"
 * @import {StageState, StageStore} from "./stage_state.js"
 * @import {ServerEvent} from "./protocol_types.js"
 */
import { Latest } from "./latest.js";
import { lead_player } from "./stage_state.js";

const kFirstPings = 5;
const kPingEvery_ms = 5000;
/** A server that leaves a ping unanswered for so long is gone, whatever the socket says. */
const kPingPatience_ms = 10000;
/** Only packets tell which way a ping-pong goes, and only of the scene's first actor: others are asked for. */
const kPollEvery_ms = 250;

export class StageSession {
  #connection;
  #store;
  #clock;
  #report;
  #refresh = new Latest(() => this.#describe());
  #markers = new Latest((/** @type {{actor: string, clip: string}} */ which) => this.#list_markers(which));
  /** Of what the markers were asked last. */
  #marked = "";

  /**
   * @param {Connection} connection
   * @param {StageStore} store
   * @param {ServerClock} clock
   * @param {(error: unknown) => void} report
   */
  constructor(connection, store, clock, report) {
    this.#connection = connection;
    this.#store = store;
    this.#clock = clock;
    this.#report = report;
  }

  start() {
    this.#connection.states.add((state) => {
      if (state.phase === "open") {
        void this.#opened(state.hello?.role !== "view");
      } else if (this.#store.state.connected) {
        this.#store.dispatch({ type: "disconnected", now_us: this.#clock.now_us() });
      }
    });
    this.#connection.events.add((event) => this.#happened(event));
    this.#store.subscribe((state) => this.#follow_markers(state));
    setInterval(() => void this.#keep_the_clock(), kPingEvery_ms);
    setInterval(() => this.#poll(), kPollEvery_ms);
  }

  /** @param {boolean} can_control */
  async #opened(can_control) {
    this.#clock.reset();
    this.#store.dispatch({ type: "connected", can_control });
    try {
      // Subscribed first: what changes while the scene is described is told, and described again.
      await this.#connection.call("events.subscribe", { scene: this.#store.state.scene });
      this.#refresh.push(undefined);
      for (let i = 0; i < kFirstPings; ++i) await this.#ping();
    } catch (error) {
      this.#report(error);
    }
  }

  async #describe() {
    const { scene } = this.#store.state;
    try {
      const [described, players] = await Promise.all([
        this.#connection.call("scene.describe", { scene }),
        this.#connection.call("playback.get", { scene }),
      ]);
      this.#store.dispatch({ type: "described", scene: described });
      this.#store.dispatch({ type: "players", ...players });
    } catch (error) {
      this.#report(error);
    }
  }

  /** @param {ServerEvent} event */
  #happened({ method, params }) {
    if (params.scene !== this.#store.state.scene) return;
    if (method === "playback.changed") {
      this.#store.dispatch({ type: "players", players: params.players, server_time_us: params.server_time_us });
    } else if (method === "playback.ended") {
      this.#store.dispatch({ type: "ended", actor: params.actor, clip: params.clip });
    } else if (method === "marker.crossed") {
      this.#store.dispatch({ type: "crossed", actor: params.actor, clip: params.clip, marker: params.marker });
    } else if (method === "scene.changed") {
      this.#refresh.push(undefined);
    }
  }

  /**
   * The line of time shows the lead player's markers: they are asked for when it takes up another clip, and after edits.
   * @param {StageState} state
   */
  #follow_markers(state) {
    const lead = state.connected ? lead_player(state) : null;
    const key = lead ? JSON.stringify([lead.actor, lead.clip, state.revision]) : "";
    if (key === this.#marked) return;
    this.#marked = key;
    if (lead) this.#markers.push({ actor: lead.actor, clip: lead.clip });
  }

  /** @param {{actor: string, clip: string}} which */
  async #list_markers({ actor, clip }) {
    const { scene } = this.#store.state;
    // Gone with the actor, the clip or the connection: each of them is told.
    const { markers } = await this.#connection.call("marker.list", { scene, actor, clip });
    this.#store.dispatch({ type: "markers", actor, clip, list: markers });
  }

  async #ping() {
    const sent_us = this.#clock.local_us();
    const { time_us } = await this.#connection.call("server.ping");
    this.#clock.add(sent_us, time_us, this.#clock.local_us());
  }

  async #keep_the_clock() {
    if (!this.#store.state.connected) return;
    const timer = setTimeout(() => this.#connection.restart("the server does not answer"), kPingPatience_ms);
    try {
      await this.#ping();
    } catch {
      // The connection says by itself that it is gone.
    } finally {
      clearTimeout(timer);
    }
  }

  #poll() {
    const { state } = this.#store;
    const lead = lead_player(state);
    if (!state.connected || !lead?.playing || lead.loop !== "ping_pong" || lead.actor === state.actors[0]?.actor) return;
    this.#connection.call("playback.get", { scene: state.scene, actor: lead.actor }).then(
      ({ players, server_time_us }) => {
        const { actor, time } = players[0];
        this.#store.dispatch({ type: "reading", actor, time, server_us: server_time_us, jumped: false });
      },
      () => {}, // gone with the actor or the connection, both of which are told
    );
  }
}
