#!/usr/bin/env node
// SPDX-License-Identifier: MIT
//
// Reads the JSON lines of ellipsejson from standard input and sends MAVLink LANDING_TARGET over UDP:
//   gst-launch-1.0 -q ... ! ellipsetrack hfov=1.01 target-diameter=1.5 ! ellipsejson ! fdsink |
//     node landing_target.js --to 127.0.0.1:14550
import dgram from 'node:dgram'
import readline from 'node:readline'
import { parseArgs } from 'node:util'
import { MavLinkProtocolV2, common, minimal } from 'node-mavlink'
import { landingTarget } from './message.js'

const usage = `usage: landing_target.js [OPTION]...
  --to HOST:PORT     address of the autopilot or a MAVLink router (127.0.0.1:14550);
                     for IPv6 as [::1]:14550
  --system N         MAVLink system id of the vehicle (1)
  --component N      MAVLink component id (191, an onboard computer)
  --hfov RAD         horizontal field of view; gives sizes, and angles if ellipsetrack has no camera
  --pitch RAD        pitch of the camera, from straight down to forward (0)
  --turn RAD         rotation of the picture's top, from forward to the right (0)
  --angles-only      omit the position; PX4 does not accept it in the vehicle's frame
  --predicted        also send predicted targets, which were not visible
`

function optionsFrom(args) {
  const { values } = parseArgs({
    args,
    options: {
      to: { type: 'string', default: '127.0.0.1:14550' },
      system: { type: 'string', default: '1' },
      component: { type: 'string', default: '191' },
      hfov: { type: 'string', default: '0' },
      pitch: { type: 'string', default: '0' },
      turn: { type: 'string', default: '0' },
      'angles-only': { type: 'boolean', default: false },
      predicted: { type: 'boolean', default: false },
      help: { type: 'boolean', default: false },
    },
  })
  const number = (name, min, max) => {
    const value = Number(values[name])
    if (!(value >= min && value <= max)) throw new Error(`--${name} ${values[name]}: not in ${min} to ${max}`)
    return value
  }
  const [, address, name, port] = /^(?:\[([^\]]+)\]|([^:]+)):(\d+)$/.exec(values.to) ?? []
  const host = address ?? name
  if (!host) throw new Error(`--to ${values.to}: expected HOST:PORT`)
  return {
    help: values.help,
    host,
    port: Number(port),
    system: number('system', 1, 255),
    component: number('component', 1, 255),
    hfov: number('hfov', 0, 3),
    mount: { pitch: number('pitch', -Math.PI, Math.PI), turn: number('turn', -Math.PI, Math.PI) },
    anglesOnly: values['angles-only'],
    predicted: values.predicted,
  }
}

/** Numbers messages and sends each in its own datagram. */
class Link {
  #socket
  #sequence = 0
  #unsent = 0
  #protocol
  #to

  constructor({ host, port, system, component }) {
    this.#socket = dgram.createSocket(host.includes(':') ? 'udp6' : 'udp4')
    this.#protocol = new MavLinkProtocolV2(system, component)
    this.#to = [port, host]
  }

  send(message) {
    const packet = this.#protocol.serialize(message, this.#sequence)
    this.#sequence = (this.#sequence + 1) % 256
    return new Promise((resolve, reject) => {
      this.#socket.send(packet, ...this.#to, (error) => (error ? reject(error) : resolve()))
    })
  }

  /** Sends a message and ignores network errors, because the next message replaces it. */
  async offer(message) {
    try {
      await this.send(message)
    } catch (error) {
      if (++this.#unsent === 1) warn(`${error.message}; continuing`)
    }
  }

  close() {
    this.#socket.close()
    if (this.#unsent > 0) warn(`messages not sent: ${this.#unsent}`)
  }
}

function warn(text) {
  process.stderr.write(`landing_target.js: ${text}\n`)
}

function heartbeat() {
  const message = new minimal.Heartbeat()
  message.type = minimal.MavType.ONBOARD_CONTROLLER
  message.autopilot = minimal.MavAutopilot.INVALID
  message.systemStatus = minimal.MavState.ACTIVE
  message.mavlinkVersion = 3
  return message
}

async function main() {
  const options = optionsFrom(process.argv.slice(2))
  if (options.help) return void process.stdout.write(usage)
  const link = new Link(options)
  let beat
  try {
    await link.send(heartbeat()) // fails if --to is invalid
    beat = setInterval(() => void link.offer(heartbeat()), 1000)
    let number = 0
    for await (const text of readline.createInterface({ input: process.stdin })) {
      ++number
      let message
      try {
        message = landingTarget(JSON.parse(text), options)
      } catch (error) {
        throw new Error(`line ${number}: ${error.message}`)
      }
      if (message) await link.offer(message)
    }
  } finally {
    clearInterval(beat)
    link.close()
  }
}

main().catch((error) => {
  warn(error.message)
  process.exitCode = 1
})
