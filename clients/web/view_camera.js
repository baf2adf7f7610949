/**
 * The page's own camera over the scene's: as long as nobody has turned it, the scene's is followed.
 *
 * @import {CameraMessage} from "./protocol_types.js"
 * @import {Orbit} from "./orbit.js"
 */
import { Listeners } from "./listeners.js";
import { orbit_of, panned, turned, zoomed } from "./orbit.js";

/** @typedef {{orbit: Orbit}} StreamCamera  the parameter `camera` of a stream */

export class ViewCamera {
  /** @type {CameraMessage | null} */
  #scene = null;
  /** @type {Orbit | null} */
  #own = null;
  /** @type {Listeners<StreamCamera | null>} null: the scene's */
  changes = new Listeners();

  /** @returns {StreamCamera | null} */
  get stream_camera() {
    return this.#own && { orbit: this.#own };
  }

  /** @param {CameraMessage | null} camera */
  follow(camera) {
    this.#scene = camera;
  }

  reset() {
    this.#set(null);
  }

  /**
   * @param {number} dx
   * @param {number} dy
   * @param {number} height
   */
  turn(dx, dy, height) {
    this.#change((orbit) => turned(orbit, dx, dy, height));
  }

  /**
   * @param {number} dx
   * @param {number} dy
   * @param {number} height
   */
  pan(dx, dy, height) {
    this.#change((orbit, scene) => panned(orbit, dx, dy, height, scene.fov_y));
  }

  /** @param {number} factor */
  zoom(factor) {
    this.#change((orbit, scene) => zoomed(orbit, factor, scene));
  }

  /** @param {(orbit: Orbit, scene: CameraMessage) => Orbit} how */
  #change(how) {
    if (!this.#scene) return; // nothing is shown yet
    this.#set(how(this.#own ?? orbit_of(this.#scene), this.#scene));
  }

  /** @param {Orbit | null} orbit */
  #set(orbit) {
    if (orbit === this.#own) return;
    this.#own = orbit;
    this.changes.tell(this.stream_camera);
  }
}
