// SPDX-License-Identifier: MIT
//
// Converts a line of ellipsejson to a MAVLink LANDING_TARGET.
import { common } from 'node-mavlink'

/**
 * Mounting of the camera on the vehicle. With zero angles it points straight down, with the top of
 * its picture forward.
 *
 * @typedef {object} Mount
 * @property {number} pitch  Pitch of the camera, from straight down to forward [rad].
 * @property {number} turn   Rotation of the picture's top, from forward to the right [rad].
 */

/**
 * Rotates a vector from the camera frame (x right, y down, z forward) to the vehicle's: forward,
 * right, down.
 *
 * @param {{x: number, y: number, z: number}} v
 * @param {Mount} mount
 */
export function bodyFromCamera(v, { pitch, turn }) {
  const top = -v.y * Math.cos(turn) - v.x * Math.sin(turn)
  return {
    x: top * Math.cos(pitch) + v.z * Math.sin(pitch),
    y: -v.y * Math.sin(turn) + v.x * Math.cos(turn),
    z: v.z * Math.cos(pitch) - top * Math.sin(pitch),
  }
}

/** The smallest rotation from a level pad's normal, straight up, to this one: w, x, y, z. */
function orientation(normal) {
  const q = [1 - normal.z, normal.y, -normal.x, 0]
  const size = Math.hypot(...q)
  return size > 0 ? q.map((part) => part / size) : [0, 1, 0, 0]
}

const focal = (line, hfov) => line.width / 2 / Math.tan(hfov / 2)

function bearing(line, target, hfov) {
  if (target.bearing) return target.bearing
  if (!hfov) throw new Error('no bearing: set a camera for ellipsetrack, or --hfov')
  const f = focal(line, hfov)
  return { x: (target.cx - (line.width - 1) / 2) / f, y: (target.cy - (line.height - 1) / 2) / f, z: 1 }
}

/** The angular size of the ellipse's bounding box, along x and y [rad]. */
function sizes(line, target, hfov) {
  if (!hfov) return [0, 0]
  const f = focal(line, hfov)
  const [c, s] = [Math.cos(target.angle_rad), Math.sin(target.angle_rad)]
  const half = [
    Math.hypot(target.semi_major * c, target.semi_minor * s),
    Math.hypot(target.semi_major * s, target.semi_minor * c),
  ]
  const off = [target.cx - (line.width - 1) / 2, target.cy - (line.height - 1) / 2]
  return off.map((o, i) => Math.atan((o + half[i]) / f) - Math.atan((o - half[i]) / f))
}

/**
 * The message for a frame; null if it has no visible target.
 *
 * @param {object} line  A parsed line of ellipsejson.
 * @param {{mount: Mount, hfov: number, anglesOnly: boolean, predicted: boolean}} options
 *   hfov: horizontal field of view [rad] of a lens without distortion; gives sizes, and angles if
 *   ellipsetrack has no camera; 0 = unknown. predicted: also convert predicted targets, which were
 *   not visible.
 * @throws {Error} if the line has no bearing and hfov is unknown.
 */
export function landingTarget(line, { mount, hfov, anglesOnly, predicted }) {
  const target = line.targets.find((one) => one.role === 'target')
  if (!target || (target.state === 'predicted' && !predicted)) return null

  const message = new common.LandingTarget()
  message.timeUsec = BigInt(Math.trunc(line.pts_ns / 1000))
  message.targetNum = 0
  message.frame = common.MavFrame.BODY_FRD
  message.type = common.LandingTargetType.VISION_OTHER
  // Angles as for a camera that points straight down: x to the right, y to the back.
  const direction = bodyFromCamera(bearing(line, target, hfov), mount)
  message.angleX = Math.atan2(direction.y, direction.z)
  message.angleY = Math.atan2(-direction.x, direction.z)
  ;[message.sizeX, message.sizeY] = sizes(line, target, hfov)
  message.q = [0, 0, 0, 0]
  if (!target.position || anglesOnly) {
    message.positionValid = 0
    return message
  }
  const position = bodyFromCamera(target.position, mount)
  Object.assign(message, position)
  message.distance = Math.hypot(position.x, position.y, position.z)
  message.q = orientation(bodyFromCamera(target.normal, mount))
  message.positionValid = 1
  return message
}
