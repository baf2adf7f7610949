/**
 * What the server says, as types: docs/PROTOCOL.md, sections 3 and 5. No code.
 *
 * Times are media seconds where nothing says otherwise; `…_us` are microseconds of the server's steady clock.
 *
 * @typedef {"once" | "repeat" | "ping_pong"} Loop
 * @typedef {"step" | "linear" | "catmull_rom" | "cubic"} Interpolation
 * @typedef {[number, number, number]} Vec3
 *
 * @typedef {object} PlayerMessage  one player, as every `playback.*` answers it
 * @property {string} actor
 * @property {string} clip
 * @property {boolean} playing
 * @property {number} time
 * @property {number} speed     media seconds a clock second; negative: backwards
 * @property {Loop} loop
 * @property {[number, number]} range  what is played of the clip
 * @property {number} duration  of the clip
 *
 * @typedef {object} PlayersMessage
 * @property {PlayerMessage[]} players
 * @property {number} server_time_us  the reading at which the players' times held
 *
 * @typedef {object} ActorMessage
 * @property {string} actor
 * @property {string | null} source
 * @property {Interpolation | null} interpolation  null: left to the clip
 * @property {boolean} visible
 * @property {boolean} show_skeleton
 * @property {{name: string, parent: string | null}[]} joints
 * @property {number} vertices
 * @property {number} triangles
 * @property {{clip: string, type: string | null, keyframes: number, duration: number, closed: boolean}[]} clips
 *
 * @typedef {object} MarkerMessage  a named instant of a clip
 * @property {number} marker  its id
 * @property {number} time
 * @property {string} name
 *
 * @typedef {object} CameraMessage
 * @property {Vec3} eye
 * @property {Vec3} target
 * @property {number} fov_y  radians
 * @property {number} near
 * @property {number} far
 *
 * @typedef {object} SceneMessage  the answer of `scene.describe`
 * @property {string} scene
 * @property {number} revision
 * @property {ActorMessage[]} actors
 * @property {CameraMessage} camera
 *
 * @typedef {object} HelloMessage
 * @property {string} server
 * @property {string} version
 * @property {number} protocol
 * @property {"view" | "control" | "admin"} role
 * @property {string[]} capabilities
 *
 * @typedef {object} ServerEvent  a notification of the server
 * @property {string} method
 * @property {Record<string, any>} params
 */
export {};
