// SPDX-License-Identifier: BSD-3-Clause
// Usage: node interop.js KESTREL. A whole simulated flight, written by `kestrel fly --mcap`: read by
// @mcap/core (all checksums), each message decoded by protobufjs with the schema in the file, each
// schema compared with that of @foxglove/schemas, and all times with the flight's table. Then the
// same file cut off: what is before the cut is read.
import { execFileSync } from 'node:child_process'
import { mkdtempSync, readFileSync, rmSync } from 'node:fs'
import { createRequire } from 'node:module'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { McapIndexedReader, McapStreamReader } from '@mcap/core'
import protobuf from 'protobufjs'
import 'protobufjs/ext/descriptor/index.js'

const require = createRequire(import.meta.url)
const { foxgloveEnumSchemas, foxgloveMessageSchemas, generateProto } =
  require('@foxglove/schemas/internal')
const { FileDescriptorSet } = require('protobufjs/ext/descriptor')

const EXPECTED = ['CameraCalibration', 'CompressedImage', 'FrameTransforms', 'ImageAnnotations',
  'Log', 'PoseInFrame', 'SceneUpdate'].map((name) => `foxglove.${name}`).concat('kestrel.FrameResult')
const failures = []
const expect = (holds, what) => { if (!holds) failures.push(what) }

const nanoseconds = ({ seconds, nanos }) => BigInt(seconds.toString()) * 1000000000n + BigInt(nanos)

function stream(bytes) {
  const reader = new McapStreamReader()
  reader.append(bytes)
  const [schemas, channels, messages] = [new Map(), new Map(), []]
  for (let record; (record = reader.nextRecord());) {
    if (record.type === 'Schema') schemas.set(record.id, record)
    if (record.type === 'Channel') channels.set(record.id, record)
    if (record.type === 'Message') messages.push(record)
  }
  return { schemas, channels, messages, isWhole: reader.done() }
}

// The fields of a type as both sides can say them: number, name, type, whether it is a list.
const fieldsOf = (type) => new Map(type.fieldsArray.map((field) => [field.id,
  `${field.name} ${field.resolve().resolvedType?.fullName ?? field.type} ${field.repeated}`]))

// All messages and enumerations of Foxglove, by its own generator.
function foxgloveRoot() {
  const root = new protobuf.Root()
  for (const schema of Object.values(foxgloveMessageSchemas)) {
    const enums = Object.values(foxgloveEnumSchemas)
      .filter((each) => each.parentSchemaName === schema.name)
    protobuf.parse(generateProto(schema, enums), root, { keepCase: true })
  }
  for (const name of ['Timestamp', 'Duration']) {
    protobuf.parse(`syntax = "proto3"; package google.protobuf;
      message ${name} { int64 seconds = 1; int32 nanos = 2; }`, root)
  }
  return root.resolveAll()
}

function compareTypes(ours, theirs) {
  const known = theirs.lookup(ours.fullName)
  if (ours instanceof protobuf.Enum) {
    expect(JSON.stringify(ours.values) === JSON.stringify(known?.values), `values of ${ours.fullName}`)
    return
  }
  if (ours instanceof protobuf.Type) {
    expect(known, `${ours.fullName} is not known to Foxglove`)
    const fields = known ? fieldsOf(known) : new Map()
    for (const [id, field] of fieldsOf(ours)) {
      expect(fields.get(id) === field, `${ours.fullName}: ${id} ${field}, there ${fields.get(id)}`)
    }
  }
  for (const nested of ours.nestedArray ?? []) compareTypes(nested, theirs)
}

function checkWhole(bytes, times) {
  const { schemas, channels, messages, isWhole } = stream(bytes)
  expect(isWhole, 'the file is whole')
  const names = new Set([...schemas.values()].map((schema) => schema.name))
  for (const name of EXPECTED) expect(names.has(name), `there is a ${name}`)

  const theirs = foxgloveRoot()
  const types = new Map()
  for (const [id, schema] of schemas) {
    const root = protobuf.Root.fromDescriptor(FileDescriptorSet.decode(schema.data)).resolveAll()
    types.set(id, root.lookupType(schema.name))
    const foxglove = root.lookup('foxglove')
    if (foxglove) compareTypes(foxglove, theirs)
  }

  const timesOf = new Map()
  for (const message of messages) {
    const channel = channels.get(message.channelId)
    const decoded = types.get(channel.schemaId).decode(message.data)
    const stamp = decoded.timestamp ?? decoded.transforms?.[0].timestamp ??
      decoded.points?.[0]?.timestamp ?? decoded.entities?.[0]?.timestamp
    if (stamp) expect(nanoseconds(stamp) === message.logTime, `${channel.topic}: two times`)
    if (!timesOf.has(channel.topic)) timesOf.set(channel.topic, [])
    timesOf.get(channel.topic).push(message.logTime)
  }
  for (const topic of ['/result', '/camera/image', '/camera/calibration', '/camera/annotations']) {
    const equal = timesOf.get(topic)?.join() === times.join()
    expect(equal, `${topic}: ${timesOf.get(topic)?.length} times, the table has ${times.length}`)
  }
  return messages
}

async function checkIndexed(bytes, count) {
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size))
  }
  const reader = await McapIndexedReader.Initialize({ readable })
  let read = 0
  let last = 0n
  for await (const message of reader.readMessages()) {
    expect(message.logTime >= last, 'messages in order of time')
    last = message.logTime
    ++read
  }
  expect(read === count, `by the index ${read} messages, in the stream ${count}`)
  let longest = 0n
  for (const { messageStartTime, messageEndTime } of reader.chunkIndexes) {
    longest = messageEndTime - messageStartTime > longest ? messageEndTime - messageStartTime : longest
  }
  expect(longest <= 1000000000n, `a chunk of ${longest} ns`)
  return reader.chunkIndexes
}

// Messages are in the file in the order of its chunks.
function checkCut(bytes, chunks, messages) {
  let before = 0
  for (const chunk of chunks) {
    const end = Number(chunk.chunkStartOffset + chunk.chunkLength)
    const atEnd = stream(bytes.subarray(0, end)).messages.length
    const within = stream(bytes.subarray(0, end - 1)).messages.length
    expect(within === before, `cut within a chunk: ${within} messages, expected ${before}`)
    expect(atEnd > before, `cut after a chunk: ${atEnd} messages, before it ${before}`)
    before = atEnd
  }
  expect(before === messages.length, `in all chunks ${before} messages of ${messages.length}`)
}

const folder = mkdtempSync(join(tmpdir(), 'kestrel-mcap-'))
try {
  const file = join(folder, 'flight.mcap')
  execFileSync(process.argv[2], ['fly', 'sim:standing', '--autopilot', 'sim:px4', '--output',
    join(folder, 'out'), '--mcap', file, '--set', 'fly.sim_autopilot.pilot.start_altitude_m=4',
    '--set', 'fly.sim_camera.scale=0.4'], { stdio: ['ignore', 'ignore', 'pipe'] })
  const rows = readFileSync(join(folder, 'out/landing_detections.csv'), 'utf8').trim().split('\n')
  const times = rows.slice(1).map((row) => BigInt(row.split(',')[1]))
  const bytes = readFileSync(file)
  const messages = checkWhole(bytes, times)
  const chunks = await checkIndexed(bytes, messages.length)
  checkCut(bytes, chunks, messages)
  console.log(`${messages.length} messages of ${times.length} frames in ${chunks.length} chunks`)
} finally {
  rmSync(folder, { recursive: true })
}
for (const failure of new Set(failures)) console.error(failure)
process.exit(failures.length === 0 ? 0 : 1)
