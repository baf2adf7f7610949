/**
 * Pointers on the picture, made into turning, moving and zooming: one finger or button turns, two fingers, Shift or another
 * button move, the wheel and a pinch zoom.
 */

/**
 * @typedef {object} GestureHandlers
 * @property {(dx: number, dy: number) => void} turn  CSS pixels
 * @property {(dx: number, dy: number) => void} pan   CSS pixels
 * @property {(factor: number) => void} zoom          of the distance
 *
 * @typedef {{x: number, y: number}} Point
 */

/** Wheels turn by pixels, lines or pages. */
const kWheelPixels = [1, 16, 400];
const kZoomPerPixel = 0.0015;
/** A pinch on a touch pad arrives as a wheel with Ctrl, in much smaller steps. */
const kPinchPerPixel = 0.01;

/**
 * @param {{deltaY: number, deltaMode: number, ctrlKey: boolean}} wheel
 * @returns {number} factor of the distance
 */
export function wheel_factor(wheel) {
  const pixels = wheel.deltaY * (kWheelPixels[wheel.deltaMode] ?? 1);
  const factor = Math.exp(pixels * (wheel.ctrlKey ? kPinchPerPixel : kZoomPerPixel));
  return Math.min(Math.max(factor, 0.5), 2); // a wild wheel does not throw the scene away
}

/** The pointers that are down, and what their moves mean. No DOM. */
export class PointerTracker {
  /** @type {Map<number, Point>} */
  #down = new Map();
  #pans = false;
  #handlers;

  /** @param {GestureHandlers} handlers */
  constructor(handlers) {
    this.#handlers = handlers;
  }

  get active() {
    return this.#down.size > 0;
  }

  /**
   * @param {number} id
   * @param {Point} at
   * @param {boolean} pans  this pointer alone moves instead of turning
   */
  press(id, at, pans) {
    if (this.#down.size >= 2) return; // a third finger says nothing
    this.#down.set(id, at);
    this.#pans = pans;
  }

  /** @param {number} id */
  lift(id) {
    this.#down.delete(id);
  }

  /**
   * @param {number} id
   * @param {Point} at
   */
  move(id, at) {
    const before = this.#down.get(id);
    if (!before) return;
    const other = [...this.#down].find(([key]) => key !== id)?.[1];
    this.#down.set(id, at);
    const [dx, dy] = [at.x - before.x, at.y - before.y];
    if (other) {
      this.#handlers.pan(dx / 2, dy / 2); // the middle between both has gone half as far
      const [was, is] = [distance(before, other), distance(at, other)];
      if (was > 0 && is > 0) this.#handlers.zoom(was / is);
    } else if (this.#pans) {
      this.#handlers.pan(dx, dy);
    } else {
      this.#handlers.turn(dx, dy);
    }
  }
}

/**
 * @param {Point} a
 * @param {Point} b
 */
const distance = (a, b) => Math.hypot(a.x - b.x, a.y - b.y);

/**
 * @param {HTMLElement} element  has `touch-action: none`, or the browser takes the gestures
 * @param {GestureHandlers} handlers
 */
export function listen_to_gestures(element, handlers) {
  const tracker = new PointerTracker(handlers);
  /** @param {PointerEvent} event @returns {Point} */
  const at = (event) => ({ x: event.clientX, y: event.clientY });
  /** @param {PointerEvent} event */
  const lift = (event) => {
    tracker.lift(event.pointerId);
    element.classList.toggle("dragging", tracker.active);
  };

  element.addEventListener("pointerdown", (event) => {
    element.setPointerCapture(event.pointerId); // a drag goes on outside of the picture
    tracker.press(event.pointerId, at(event), event.shiftKey || event.button > 0);
    element.classList.add("dragging");
  });
  element.addEventListener("pointermove", (event) => tracker.move(event.pointerId, at(event)));
  element.addEventListener("pointerup", lift);
  element.addEventListener("pointercancel", lift);
  element.addEventListener("contextmenu", (event) => event.preventDefault()); // the right button moves
  element.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      handlers.zoom(wheel_factor(event));
    },
    { passive: false },
  );
}
