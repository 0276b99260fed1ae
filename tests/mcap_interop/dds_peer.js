// SPDX-License-Identifier: BSD-3-Clause
// Fast DDS, by the program fast_dds_peer, which says what its lines are.
import { spawn } from 'node:child_process'

export const ddsType = (type) => type.replace('/', '::msg::dds_::') + '_'

export class Peer {
  // What was found: participants and endpoints by their Gid, in order.
  entities = new Map()
  // What was heard: serialized messages by topic, in order.
  messages = new Map()

  constructor(program) {
    this.program = spawn(program, { stdio: ['pipe', 'pipe', 'inherit'] })
    this.rest = Buffer.alloc(0)
    this.program.stdout.on('data', (bytes) => this.#take(bytes))
    this.ended = new Promise((resolve) => this.program.on('exit', resolve))
    this.ready = new Promise((resolve) => { this.isReady = resolve })
  }

  read(topic, type, qos) {
    this.messages.set(topic, [])
    this.program.stdin.write(`read ${topic} ${ddsType(type)} ${qos}\n`)
  }

  write(topic, type, qos, bytes) {
    this.program.stdin.write(`write ${topic} ${ddsType(type)} ${qos} ${bytes.length}\n`)
    this.program.stdin.write(bytes)
  }

  end() {
    this.program.stdin.end()
    return this.ended
  }

  #take(bytes) {
    this.rest = Buffer.concat([this.rest, bytes])
    for (let end; (end = this.rest.indexOf('\n')) >= 0;) {
      const words = this.rest.toString('latin1', 0, end).split(' ')
      const next = end + 1 + Number(words.at(-1))
      if (this.rest.length < next) return
      this.#note(words, this.rest.subarray(end + 1, next))
      this.rest = this.rest.subarray(next)
    }
  }

  #note([kind, ...words], bytes) {
    if (kind === 'domain') {
      this.domain = words[0]
      this.uri = bytes.toString()
      this.isReady()
    } else if (kind === 'message') {
      this.messages.get(words[0]).push(Buffer.from(bytes))
    } else {
      const [gid, topic, type] = words
      this.entities.set(gid, { kind, topic, type, userData: bytes.toString() })
    }
  }
}
