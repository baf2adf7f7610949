/**
 * What a person can do, as calls to the server. Views get these functions and never the connection.
 *
 * @import {Connection} from "./connection.js"
 * @import {StageStore} from "./stage_state.js"
 * @import {Interpolation, Loop} from "./protocol_types.js"
 */
import { Latest } from "./latest.js";
import { selected_players } from "./stage_state.js";

/** @typedef {ReturnType<typeof make_actions>} Actions */

/**
 * @param {Connection} connection
 * @param {StageStore} store
 * @param {(error: unknown) => void} report
 */
export function make_actions(connection, store, report) {
  /** Which players a command concerns. */
  const scope = () => {
    const { scene, selected } = store.state;
    return selected === null ? { scene } : { scene, actor: selected };
  };

  /**
   * Carried out, or reported: never thrown.
   * @param {string} method
   * @param {Record<string, unknown>} params
   */
  const call = async (method, params) => {
    try {
      return await connection.call(method, params);
    } catch (error) {
      report(error);
      return null;
    }
  };

  /**
   * @param {string} method
   * @param {Record<string, unknown>} [params]
   */
  const playback = async (method, params = {}) => {
    await answered(call(method, { ...scope(), ...params }));
  };

  /**
   * What the players are after a command is shown without waiting for the event.
   * @param {Promise<any>} asked
   */
  const answered = async (asked) => {
    const answer = await asked;
    if (answer) store.dispatch({ type: "players", ...answer });
  };

  const seeks = new Latest((/** @type {number} */ time) => playback("playback.seek", { time }));
  const speeds = new Latest((/** @type {number} */ speed) => playback("playback.set", { speed }));

  /** @type {string[]} actors that a drag of the scrubber holds, to be let go on afterwards */
  let held = [];

  return {
    play: () => playback("playback.play"),
    pause: () => playback("playback.pause"),
    stop: () => playback("playback.stop"),
    toggle_play: () => {
      const playing = selected_players(store.state).some((p) => p.playing);
      return playback(playing ? "playback.pause" : "playback.play");
    },
    /** @param {number} seconds */
    step_seconds: (seconds) => playback("playback.step", { seconds }),
    /** @param {number} keyframes */
    step_keyframes: (keyframes) => playback("playback.step", { keyframes }),
    /** @param {number} time  media seconds; while one is on its way, only the newest waits */
    seek: (time) => seeks.push(time),
    /** @param {number} speed */
    set_speed: (speed) => speeds.push(speed),
    /** @param {Loop} loop */
    set_loop: (loop) => playback("playback.set", { loop }),

    /** A drag of the scrubber begins: what plays is held, or it would run away under the finger. */
    hold: () => {
      held = selected_players(store.state).flatMap((p) => (p.playing ? p.actor : []));
      if (held.length > 0) void playback("playback.pause");
    },
    /** It has ended: what played goes on. Whether the last seek leaves before or after this makes no difference. */
    release: () => {
      const { scene } = store.state;
      for (const actor of held) void playback("playback.play", { scene, actor });
      held = [];
    },

    /** @param {Interpolation | null} interpolation  null: as the clip says */
    set_interpolation: (interpolation) => {
      const { scene, actors, selected } = store.state;
      const names = selected === null ? actors.map((a) => a.actor) : [selected];
      if (names.length === 1) return call("actor.update", { scene, actor: names[0], interpolation });
      const edits = names.map((actor) => ({ method: "actor.update", params: { actor, interpolation } }));
      return call("edit.apply", { scene, edits }); // one step to undo
    },
    /**
     * @param {string} actor
     * @param {boolean} visible
     */
    set_visible: (actor, visible) => call("actor.update", { scene: store.state.scene, actor, visible }),
    /**
     * @param {string} actor
     * @param {boolean} show_skeleton
     */
    set_skeleton: (actor, show_skeleton) => call("actor.update", { scene: store.state.scene, actor, show_skeleton }),
    /**
     * Another clip, faded to from what is shown; a player that stands still stands at its beginning.
     * @param {string} actor
     * @param {string} clip
     */
    play_clip: (actor, clip) => {
      const { scene, players, fade_s } = store.state;
      const plays = players[actor]?.playing ?? false;
      const started = answered(call("playback.play", { scene, actor, clip, ...(plays ? { fade: fade_s } : {}) }));
      // Carried out in the order they are sent: nothing moves in between.
      return plays ? started : Promise.all([started, answered(call("playback.pause", { scene, actor }))]);
    },
    /** @param {number} seconds */
    set_fade: (seconds) => store.dispatch({ type: "fade", seconds }),
    /** @param {string | null} actor  null: all of them */
    select: (actor) => store.dispatch({ type: "selected", actor }),
  };
}
