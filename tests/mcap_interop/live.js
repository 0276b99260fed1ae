// SPDX-License-Identifier: BSD-3-Clause
// Usage: node live.js KESTREL. A whole simulated flight, watched by @foxglove/ws-protocol while it
// happens: each message decoded by protobufjs with the schema that was advertised, each schema
// compared with that of @foxglove/schemas, and all times with the flight's table.
import { spawn } from 'node:child_process'
import { mkdtempSync, readFileSync, rmSync } from 'node:fs'
import { createRequire } from 'node:module'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import WebSocket from 'ws'
import { expect, finish, FLIGHT } from './checks.js'
import { EXPECTED, timeIn, timesOf, typeOf } from './foxglove.js'

const { FoxgloveClient } = createRequire(import.meta.url)('@foxglove/ws-protocol')
// Those of each frame, and those of each frame that a slow viewer may lose.
const [OF_FRAMES, IMAGE] = [['/camera/calibration', '/camera/annotations', '/result'], '/camera/image']

// Starts the flight; resolves to it, when it has said where viewers connect.
function start(args) {
  const program = spawn(process.argv[2], args, { stdio: ['ignore', 'ignore', 'pipe'] })
  const ended = new Promise((resolve) => program.on('exit', resolve))
  return new Promise((resolve, reject) => {
    let said = ''
    program.stderr.on('data', (text) => {
      said += text
      const link = said.match(/for Foxglove: (ws:\S+)/)
      if (link) resolve({ link: link[1], ended })
    })
    ended.then(() => reject(new Error(said)))
  })
}

// Subscribes to all that there is, until the other side ends it; resolves to the times of the
// messages by topic, the names of their types, and what the server said of itself.
function watch(link, subprotocol) {
  const client = new FoxgloveClient({ ws: new WebSocket(link, [subprotocol]) })
  const seen = { times: new Map(), names: new Set(), info: null, statuses: [] }
  const topics = new Map()
  client.on('serverInfo', (info) => { seen.info = info })
  client.on('status', ({ message }) => seen.statuses.push(message))
  client.on('error', (error) => expect(false, `the client says ${error}`))
  client.on('advertise', (channels) => {
    for (const { id, topic, encoding, schemaName, schema, schemaEncoding } of channels) {
      expect(encoding === 'protobuf' && schemaEncoding === 'protobuf', `${topic} is ${encoding}`)
      const type = typeOf(Buffer.from(schema, 'base64'), schemaName)
      topics.set(client.subscribe(id), { topic, type })
      seen.names.add(schemaName)
      seen.times.set(topic, [])
    }
  })
  client.on('message', ({ subscriptionId, timestamp, data }) => {
    const { topic, type } = topics.get(subscriptionId)
    const decoded = type.decode(new Uint8Array(data.buffer, data.byteOffset, data.byteLength))
    expect((timeIn(decoded) ?? timestamp) === timestamp, `${topic}: two times`)
    seen.times.get(topic).push(timestamp)
  })
  return new Promise((resolve) => client.on('close', () => resolve(seen)))
}

function checkTimes(seen, table) {
  const inTable = new Map(table.map((time, i) => [time, i]))
  for (const topic of [...OF_FRAMES, IMAGE]) {
    const indices = seen.times.get(topic).map((time) => inTable.get(time) ?? -1)
    const inOrder = indices.every((index, i) => index > (i === 0 ? -1 : indices[i - 1]))
    expect(inOrder, `${topic}: times that the table has not, or not in order`)
    const enough = (topic === IMAGE ? 0.5 : 0.9) * table.length
    expect(indices.length >= enough, `${topic}: ${indices.length} of ${table.length} frames`)
  }
}

const folder = mkdtempSync(join(tmpdir(), 'kestrel-live-'))
try {
  const { link, ended } = await start([...FLIGHT, '--output', join(folder, 'out'), '--console',
    '127.0.0.1:0', '--set', 'console.token=0123456789abcdef', '--set',
    'console.max_image_rate_hz=200', '--set', 'console.message_queue=20000'])
  const [seen, older] = await Promise.all(
    [watch(link, 'foxglove.sdk.v1'), watch(link, 'foxglove.websocket.v1')])
  await ended
  const table = timesOf(readFileSync(join(folder, 'out/landing_detections.csv'), 'utf8'))
  for (const name of EXPECTED) expect(seen.names.has(name), `there is a ${name}`)
  expect(seen.info?.capabilities.length === 0, 'the server says that it is to look at only')
  checkTimes(seen, table)
  checkTimes(older, table)
  expect(seen.times.get('/log').length > 0, 'something is in /log')
  for (const status of seen.statuses) console.log(status)
  const count = [...seen.times.values()].reduce((sum, times) => sum + times.length, 0)
  console.log(`${count} messages, /result of ${seen.times.get('/result').length} of ${table.length} frames, ` +
    `${seen.times.get(IMAGE).length} images`)
} finally {
  rmSync(folder, { recursive: true })
}
finish()
