// SPDX-License-Identifier: BSD-3-Clause
// Usage: node interop.js KESTREL. A whole simulated flight, written by `kestrel fly --mcap`: read by
// @mcap/core (all checksums), each message decoded by protobufjs with the schema in the file, each
// schema compared with that of @foxglove/schemas, and all times with the flight's table. Then the
// same file cut off: what is before the cut is read.
import { execFileSync } from 'node:child_process'
import { mkdtempSync, readFileSync, rmSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { McapIndexedReader, McapStreamReader } from '@mcap/core'
import { expect, finish, FLIGHT } from './checks.js'
import { EXPECTED, timeIn, timesOf, typeOf } from './foxglove.js'

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

function checkWhole(bytes, times) {
  const { schemas, channels, messages, isWhole } = stream(bytes)
  expect(isWhole, 'the file is whole')
  const names = new Set([...schemas.values()].map((schema) => schema.name))
  for (const name of EXPECTED) expect(names.has(name), `there is a ${name}`)

  const types = new Map()
  for (const [id, schema] of schemas) types.set(id, typeOf(schema.data, schema.name))

  const timesByTopic = new Map()
  for (const message of messages) {
    const channel = channels.get(message.channelId)
    const decoded = types.get(channel.schemaId).decode(message.data)
    const time = timeIn(decoded) ?? message.logTime
    expect(time === message.logTime, `${channel.topic}: two times`)
    if (!timesByTopic.has(channel.topic)) timesByTopic.set(channel.topic, [])
    timesByTopic.get(channel.topic).push(message.logTime)
  }
  for (const topic of ['/result', '/camera/image', '/camera/calibration', '/camera/annotations']) {
    const written = timesByTopic.get(topic)
    expect(written?.join() === times.join(),
      `${topic}: ${written?.length} times, the table has ${times.length}`)
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
  execFileSync(process.argv[2], [...FLIGHT, '--output', join(folder, 'out'), '--mcap', file],
    { stdio: ['ignore', 'ignore', 'pipe'] })
  const times = timesOf(readFileSync(join(folder, 'out/landing_detections.csv'), 'utf8'))
  const bytes = readFileSync(file)
  const messages = checkWhole(bytes, times)
  const chunks = await checkIndexed(bytes, messages.length)
  checkCut(bytes, chunks, messages)
  console.log(`${messages.length} messages of ${times.length} frames in ${chunks.length} chunks`)
} finally {
  rmSync(folder, { recursive: true })
}
finish()
