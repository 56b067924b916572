// SPDX-License-Identifier: MIT
//
// Decodes the messages received on the loopback interface and compares them with the scene's truth.
import assert from 'node:assert/strict'
import { spawn } from 'node:child_process'
import dgram from 'node:dgram'
import { once } from 'node:events'
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs'
import { networkInterfaces, tmpdir } from 'node:os'
import { join } from 'node:path'
import { PassThrough } from 'node:stream'
import { before, test } from 'node:test'
import { fileURLToPath } from 'node:url'
import { MavLinkPacketParser, MavLinkPacketSplitter, common, minimal } from 'node-mavlink'
import { bodyFromCamera } from './message.js'

const program = fileURLToPath(new URL('landing_target.js', import.meta.url))
const registry = { ...minimal.REGISTRY, ...common.REGISTRY }
const hfov = 1.012 // of ellipsetestsrc
const diameter = 1.5
const frames = 60

async function textOf(stream) {
  let text = ''
  for await (const part of stream.setEncoding('utf8')) text += part
  return text
}

/** The JSON lines of a rendered landing. */
async function linesOf(properties) {
  const line = `-q ellipsetestsrc num-buffers=${frames} ! ellipsetrack ${properties} ! ellipsejson ! fdsink`
  const gst = spawn('gst-launch-1.0', line.split(' '), { stdio: ['ignore', 'pipe', 'inherit'] })
  const [text, [status]] = await Promise.all([textOf(gst.stdout), once(gst, 'close')])
  assert.equal(status, 0)
  return text.trimEnd().split('\n')
}

/** Runs the program on these lines. @returns its exit status and standard error. */
async function run(lines, options, nodeOptions = []) {
  const child = spawn(process.execPath, [...nodeOptions, program, ...options], {
    stdio: ['pipe', 'inherit', 'pipe'],
    timeout: 60000, // kills a program that hangs
  })
  child.stdin.on('error', () => {}) // the program may exit before it has read everything
  child.stdin.end(lines.map((line) => line + '\n').join(''))
  const [errorOutput, [status]] = await Promise.all([textOf(child.stderr), once(child, 'close')])
  return { errorOutput, status }
}

/** Runs the program and decodes the messages that it sends to an address of this machine. */
async function sentTo(address, lines, options, nodeOptions) {
  const isIpv6 = address.includes(':')
  const socket = dgram.createSocket(isIpv6 ? 'udp6' : 'udp4')
  socket.bind(0, address)
  await once(socket, 'listening')
  const { port } = socket.address()
  const stream = new PassThrough()
  const parser = new MavLinkPacketParser()
  const packets = []
  stream.pipe(new MavLinkPacketSplitter()).pipe(parser)
  parser.on('data', (packet) => packets.push(packet))
  const marker = 'end of the messages' // the loopback preserves the order of datagrams
  socket.on('message', (datagram) => (String(datagram) === marker ? stream.end() : stream.write(datagram)))
  const to = isIpv6 ? `[${address}]:${port}` : `${address}:${port}`
  const ended = await run(lines, ['--to', to, ...options], nodeOptions)
  socket.send(marker, port, address)
  await once(parser, 'end')
  socket.close()
  const messages = packets.map((packet) => ({
    header: packet.header,
    data: packet.protocol.data(packet.payload, registry[packet.header.msgid]),
  }))
  return { ...ended, messages, targets: messages.filter((m) => m.data instanceof common.LandingTarget) }
}

const sentFor = (lines, ...options) => sentTo('127.0.0.1', lines, options)

const truthOf = (line) => line.targets.find((one) => one.role === 'truth')
const targetOf = (line) => line.targets.find((one) => one.role === 'target')
const near = (actual, expected, tolerance, what) =>
  assert.ok(Math.abs(actual - expected) <= tolerance, `${what}: ${actual}, not ${expected}`)

let withPose
let withoutCamera
before(async () => {
  withPose = await linesOf(`hfov=${hfov} target-diameter=${diameter}`)
  withoutCamera = await linesOf('')
})

/** Rotates a vector by a quaternion w, x, y, z. */
function turned([w, x, y, z], v) {
  const t = { x: 2 * (y * v.z - z * v.y), y: 2 * (z * v.x - x * v.z), z: 2 * (x * v.y - y * v.x) }
  return {
    x: v.x + w * t.x + y * t.z - z * t.y,
    y: v.y + w * t.y + z * t.x - x * t.z,
    z: v.z + w * t.z + x * t.y - y * t.x,
  }
}

/** Maximum distance between the message's circle, projected into the picture, and an ellipse [px]. */
function distanceFrom(ellipse, line, message) {
  const f = line.width / 2 / Math.tan(hfov / 2)
  const [c, s] = [Math.cos(ellipse.angle_rad), Math.sin(ellipse.angle_rad)]
  let farthest = 0
  for (let i = 0; i < 90; ++i) {
    const turn = (i * Math.PI) / 45
    const rim = turned(message.q, { x: (diameter / 2) * Math.cos(turn), y: (diameter / 2) * Math.sin(turn), z: 0 })
    const body = { x: message.x + rim.x, y: message.y + rim.y, z: message.z + rim.z }
    const u = (f * body.y) / body.z + (line.width - 1) / 2 - ellipse.cx // the camera points down
    const v = (-f * body.x) / body.z + (line.height - 1) / 2 - ellipse.cy
    const radius = Math.hypot((c * u + s * v) / ellipse.semi_major, (c * v - s * u) / ellipse.semi_minor)
    farthest = Math.max(farthest, Math.abs(radius - 1) * ellipse.semi_minor)
  }
  return farthest
}

test('each frame has a position that matches the scene', async () => {
  const { status, messages, targets } = await sentFor(withPose)
  assert.equal(status, 0)
  assert.ok(messages[0].data instanceof minimal.Heartbeat)
  assert.equal(targets.length, frames)
  targets.forEach(({ header, data }, i) => {
    const line = JSON.parse(withPose[i])
    assert.equal(header.sysid, 1)
    assert.equal(header.compid, 191)
    assert.equal(data.timeUsec, BigInt(Math.trunc(line.pts_ns / 1000)))
    assert.equal(data.targetNum, 0)
    assert.equal(data.frame, common.MavFrame.BODY_FRD)
    assert.equal(data.type, common.LandingTargetType.VISION_OTHER)
    assert.equal(data.positionValid, 1)
    near(Math.hypot(...data.q), 1, 1e-6, 'size of q')
    near(data.distance, Math.hypot(data.x, data.y, data.z), 1e-4, 'distance')
    near(Math.tan(data.angleX), data.y / data.z, 1e-5, 'angle_x')
    near(Math.tan(data.angleY), -data.x / data.z, 1e-5, 'angle_y')
    // The message's circle, projected into the picture, is the scene's true ellipse.
    const off = distanceFrom(truthOf(line), line, data)
    assert.ok(off < 0.5, `frame ${i}: projection error ${off} px`)
  })
})

test('messages are sent at 10 Hz or more', async () => {
  const { targets } = await sentFor(withPose)
  targets.slice(1).forEach(({ data }, i) => assert.ok(data.timeUsec - targets[i].data.timeUsec <= 100000n))
})

test('without a pose, messages have angles and sizes', async () => {
  const { targets } = await sentFor(withoutCamera, '--hfov', String(hfov))
  assert.equal(targets.length, frames)
  targets.forEach(({ data }, i) => {
    const line = JSON.parse(withoutCamera[i])
    const truth = truthOf(line)
    const f = line.width / 2 / Math.tan(hfov / 2)
    assert.equal(data.positionValid, 0)
    assert.equal(data.distance, 0)
    near(data.angleX, Math.atan((truth.cx - (line.width - 1) / 2) / f), 0.5 / f, 'angle_x')
    near(data.angleY, Math.atan((truth.cy - (line.height - 1) / 2) / f), 0.5 / f, 'angle_y')
    for (const size of [data.sizeX, data.sizeY]) {
      assert.ok(size > (2 * truth.semi_minor - 1) / f / 1.1 && size < (2 * truth.semi_major + 1) / f)
    }
  })
})

test('--angles-only omits the position', async () => {
  const { targets } = await sentFor(withPose, '--angles-only')
  assert.equal(targets.length, frames)
  targets.forEach(({ data }, i) => {
    const { bearing } = targetOf(JSON.parse(withPose[i]))
    assert.equal(data.positionValid, 0)
    near(data.angleX, Math.atan2(bearing.x, bearing.z), 1e-6, 'angle_x')
    near(data.angleY, Math.atan2(bearing.y, bearing.z), 1e-6, 'angle_y')
  })
})

test('no message is sent while the target is lost', async () => {
  const lost = withPose.map((text, i) => {
    const line = JSON.parse(text)
    if (i >= 20 && i < 40) line.targets = line.targets.filter((one) => one.role === 'truth')
    if (i === 40) targetOf(line).state = 'predicted'
    return JSON.stringify(line)
  })
  const { targets } = await sentFor(lost)
  assert.equal(targets.length, frames - 21)
  const { targets: more } = await sentFor(lost, '--predicted')
  assert.equal(more.length, frames - 20)
})

test('vectors are rotated by the mounting of the camera', () => {
  const close = (actual, expected) =>
    ['x', 'y', 'z'].forEach((axis) => near(actual[axis], expected[axis], 1e-12, axis))
  const ahead = { x: 0, y: 0, z: 1 }
  const right = { x: 1, y: 0, z: 0 }
  close(bodyFromCamera(ahead, { pitch: 0, turn: 0 }), { x: 0, y: 0, z: 1 })
  close(bodyFromCamera(right, { pitch: 0, turn: 0 }), { x: 0, y: 1, z: 0 })
  close(bodyFromCamera(ahead, { pitch: Math.PI / 2, turn: 0 }), { x: 1, y: 0, z: 0 })
  close(bodyFromCamera(right, { pitch: 0, turn: Math.PI / 2 }), { x: -1, y: 0, z: 0 })
})

test('an invalid line, or one without a bearing, ends the program with its number', async () => {
  const broken = await sentFor([withPose[0], '{"frame":1,'])
  assert.equal(broken.status, 1)
  assert.match(broken.errorOutput, /^landing_target\.js: line 2: /)
  const blind = await sentFor(withoutCamera)
  assert.equal(blind.status, 1)
  assert.match(blind.errorOutput, /line 1: no bearing: set a camera for ellipsetrack, or --hfov/)
  const port = await sentFor([], '--to', 'nowhere')
  assert.match(port.errorOutput, /--to nowhere: expected HOST:PORT/)
})

test('an address that cannot be sent to ends the program', async () => {
  for (const to of ['255.255.255.255:14550', '127.0.0.1:99999']) { // neither is sent off this machine
    const { status, errorOutput } = await run(withPose, ['--to', to])
    assert.equal(status, 1, to)
    assert.match(errorOutput, /^landing_target\.js: .+\n$/, to)
  }
})

const hasIpv6 = Object.values(networkInterfaces()).some((all) => all.some((one) => one.address === '::1'))
test('messages can be sent to an IPv6 address', { skip: !hasIpv6 && 'this machine has no ::1' }, async () => {
  const { status, targets } = await sentTo('::1', withPose, [])
  assert.equal(status, 0)
  assert.equal(targets.length, frames)
})

test('the program continues after a temporary network error', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'landing-target-'))
  const preload = join(folder, 'preload.cjs')
  writeFileSync(
    preload,
    `const { Socket } = require('node:dgram')
     const send = Socket.prototype.send
     let number = 0
     Socket.prototype.send = function (packet, port, host, done) {
       const isDown = ++number > 10 && number <= 15
       return isDown ? done(new Error('send ENETUNREACH')) : send.call(this, packet, port, host, done)
     }`,
  )
  const { status, errorOutput, messages } = await sentTo('127.0.0.1', withPose, [], ['--require', preload])
  rmSync(folder, { recursive: true })
  assert.equal(status, 0)
  assert.equal(
    errorOutput,
    'landing_target.js: send ENETUNREACH; continuing\nlanding_target.js: messages not sent: 5\n',
  )
  assert.ok(messages.length >= 1 + frames - 5) // and one heartbeat per second
})
