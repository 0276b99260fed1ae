// SPDX-License-Identifier: BSD-3-Clause
// Usage: node interop.js MAVLINK_INTEROP. Every message that Kestrel knows, with every field, signed
// and not: what Kestrel writes is read by node-mavlink, and what that writes is read by Kestrel.
import { execFileSync } from 'node:child_process'
import { chmodSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { PassThrough } from 'node:stream'
import mappings from 'mavlink-mappings'
import mavlink from 'node-mavlink'

const { minimal, standard, common, ardupilotmega, development } = mappings
const { MavLinkPacketSplitter, MavLinkPacketParser, MavLinkProtocolV2 } = mavlink
const REGISTRY = Object.assign(
  {}, ...[minimal, standard, common, ardupilotmega, development].map((dialect) => dialect.REGISTRY))
const KEY = Buffer.from(Array.from({ length: 32 }, (_, i) => 7 * i + 3))
const SYSTEM = 42
const COMPONENT = 191

const program = process.argv[2]
const failures = []

const kestrel = (mode, keyFile, input) =>
  execFileSync(program, keyFile ? [mode, keyFile] : [mode], { input, encoding: 'utf8' })
    .trim().split('\n').filter(Boolean).map((line) => JSON.parse(line))

// A value of node-mavlink as Kestrel's JSON has it.
const plain = (value) => {
  if (typeof value === 'bigint') return value.toString()
  if (Array.isArray(value) || ArrayBuffer.isView(value)) return Array.from(value, plain)
  return value
}

const equals = (a, b) => JSON.stringify(a) === JSON.stringify(b)

function compare(what, message, read) {
  for (const field of REGISTRY[message.id].FIELDS) {
    const [ours, theirs] = [message.fields[field.source], plain(read(field))]
    if (!equals(ours, theirs)) {
      failures.push(`${what} ${message.name}.${field.source}: ${JSON.stringify(ours)} here, ` +
        `${JSON.stringify(theirs)} there`)
    }
  }
}

async function decode(frames) {
  const input = new PassThrough()
  const packets = []
  const reader = input.pipe(new MavLinkPacketSplitter()).pipe(new MavLinkPacketParser())
  reader.on('data', (packet) => packets.push(packet))
  for (const frame of frames) input.write(Buffer.from(frame, 'hex'))
  input.end()
  await new Promise((resolve) => reader.on('end', resolve))
  return packets
}

async function checkWritten(what, keyFile) {
  const messages = kestrel('write', keyFile)
  const packets = await decode(messages.map((message) => message.frame))
  if (packets.length !== messages.length) {
    failures.push(`${what}: ${packets.length} of ${messages.length} packets read`)
  }
  packets.forEach((packet, i) => {
    const message = messages[i]
    const { sysid, compid, seq, msgid } = packet.header
    if (!equals([sysid, compid, seq, msgid], [SYSTEM, COMPONENT, i, message.id])) {
      failures.push(`${what} ${message.name}: header ${[sysid, compid, seq, msgid]}`)
    }
    if (keyFile && !packet.signature?.matches(KEY)) {
      failures.push(`${what} ${message.name}: signature does not match`)
    }
    const data = packet.protocol.data(packet.payload, REGISTRY[msgid])
    compare(what, message, (field) => data[field.name])
  })
  return messages
}

// A field of Kestrel's JSON as node-mavlink wants it.
function native(field, value) {
  const wide = field.type.includes('64')
  if (Array.isArray(value)) return value.map((element) => (wide ? BigInt(element) : element))
  return wide ? BigInt(value) : value
}

function encode(message, sequence, isSigned) {
  const data = new REGISTRY[message.id]()
  for (const field of REGISTRY[message.id].FIELDS) {
    data[field.name] = native(field, message.fields[field.source])
  }
  const flags = isSigned ? MavLinkProtocolV2.IFLAG_SIGNED : 0
  const protocol = new MavLinkProtocolV2(SYSTEM, COMPONENT, flags)
  const frame = protocol.serialize(data, sequence)
  const now = Date.UTC(2023, 10, 15) + sequence
  return (isSigned ? protocol.sign(frame, 1, KEY, now) : frame).toString('hex')
}

function checkRead(what, keyFile, messages) {
  const frames = messages.map((message, i) => encode(message, i, Boolean(keyFile)))
  const read = kestrel('read', keyFile, frames.join('\n') + '\n')
  if (read.length !== messages.length) {
    failures.push(`${what}: ${read.length} of ${messages.length} packets read`)
  }
  read.forEach((message, i) => {
    if (message.id !== messages[i].id || !equals(message.fields, messages[i].fields)) {
      failures.push(`${what} ${messages[i].name}: ${JSON.stringify(message.fields)} here, ` +
        `${JSON.stringify(messages[i].fields)} there`)
    }
  })
}

const folder = mkdtempSync(join(tmpdir(), 'kestrel-interop-'))
try {
  const keyFile = join(folder, 'key')
  writeFileSync(keyFile, KEY)
  chmodSync(keyFile, 0o600)
  const messages = await checkWritten('written', null)
  await checkWritten('written signed', keyFile)
  checkRead('read', null, messages)
  checkRead('read signed', keyFile, messages)
  if (kestrel('read', keyFile, messages.map((message) => message.frame).join('\n')).length > 0) {
    failures.push('unsigned packets were believed')
  }
  console.log(`${messages.length} messages in both directions, unsigned and signed`)
} finally {
  rmSync(folder, { recursive: true })
}
failures.forEach((failure) => console.error(failure))
process.exit(failures.length > 0 ? 1 : 0)
