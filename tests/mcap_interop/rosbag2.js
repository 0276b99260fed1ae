// SPDX-License-Identifier: BSD-3-Clause
// Usage: node rosbag2.js KESTREL. A simulated flight, written as bags of ROS 2 by @mcap/core and by
// sqlite3, with @foxglove/rosmsg2-serialization and the official definitions: the table of `kestrel
// land` on each is that of the recording, without the names of the frames and detect_ms, to the byte
// where the encoding keeps the gray values. Then what `kestrel convert` writes, read by them.
import { execFileSync } from 'node:child_process'
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { createRequire } from 'node:module'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { McapIndexedReader, McapWriter } from '@mcap/core'
import { expect, finish } from './checks.js'
import { cameraInfoOf, decode, encode, isOfficial, longName, mountOf, readGrayPng, readTable,
  shortName, simulate, stampOf, timeOf } from './ros2.js'

const require = createRequire(import.meta.url)
const jpeg = require('jpeg-js')
const zstd = require('@foxglove/wasm-zstd')
const lz4 = require('@foxglove/wasm-lz4')
const kestrel = process.argv[2]
const TOLERANCE_PX = 1 // what an encoding that does not keep the gray values may shift

const run = (...args) => execFileSync(kestrel, args, { stdio: ['ignore', 'ignore', 'pipe'] })

// Pixels of some channels; each is a list of values, or one for all.
function interleave(size, ...channels) {
  const data = Buffer.alloc(size * channels.length)
  channels.forEach((channel, k) => {
    for (let i = 0; i < size; ++i) data[i * channels.length + k] = channel[i] ?? channel
  })
  return data
}

function raw(encoding, channelsOf) {
  return ({ width, height, data }, header) => {
    const channels = channelsOf(data)
    const image = { header, height, width, encoding, is_bigendian: 0, step: width * channels.length,
      data: interleave(data.length, ...channels) }
    return { topic: '/camera/image_raw', type: 'sensor_msgs/Image', message: image }
  }
}
const gray = (encoding) => raw(encoding, (data) => [data])

function compressed(format, bytesOf) {
  return (image, header) => ({
    topic: '/camera/image_raw/compressed',
    type: 'sensor_msgs/CompressedImage',
    message: { header, format, data: bytesOf(image) }
  })
}
const png = compressed('png', ({ path }) => readFileSync(path))
const jpg = compressed('jpeg', ({ width, height, data }) =>
  jpeg.encode({ width, height, data: interleave(data.length, data, data, data, [255]) }, 95).data)

// All messages of a bag, in order of time.
function messagesOf(recording, imageOf) {
  const messages = []
  const add = (time, topic, type, message) =>
    messages.push({ time, topic, type, data: Buffer.from(encode(type, message)) })
  const header = (time, frame) => ({ stamp: stampOf(time), frame_id: frame })
  const start = recording.poses[0].time
  add(start, '/tf_static', 'tf2_msgs/TFMessage',
    { transforms: [mountOf(recording, header(start, 'base_link'), 'camera')] })
  for (const { time, pose } of recording.poses) {
    add(time, '/pose', 'geometry_msgs/PoseStamped', { header: header(time, 'map'), pose })
  }
  for (const { time, path, image } of recording.frames) {
    add(time, '/camera/camera_info', 'sensor_msgs/CameraInfo',
      cameraInfoOf(recording, header(time, 'camera')))
    const { topic, type, message } = imageOf({ ...image, path }, header(time, 'camera'))
    add(time, topic, type, message)
  }
  return messages.sort((a, b) => (a.time < b.time ? -1 : a.time > b.time ? 1 : 0))
}

// As rosbag2's storage plugin has it.
async function writeMcap(path, messages, options) {
  const parts = []
  let size = 0
  const writable = {
    position: () => BigInt(size),
    write: async (bytes) => { parts.push(Buffer.from(bytes)); size += bytes.length }
  }
  const writer = new McapWriter({ writable, chunkSize: 1 << 20, ...options })
  await writer.start({ profile: 'ros2', library: 'interop' })
  const channels = new Map()
  for (const { topic, type } of messages) {
    if (channels.has(topic)) continue
    const schemaId = await writer.registerSchema(
      { name: longName(type), encoding: 'ros2msg', data: Buffer.from('') })
    channels.set(topic, await writer.registerChannel(
      { schemaId, topic, messageEncoding: 'cdr', metadata: new Map() }))
  }
  for (const [sequence, { time, topic, data }] of messages.entries()) {
    await writer.addMessage(
      { channelId: channels.get(topic), sequence, logTime: time, publishTime: time, data })
  }
  await writer.end()
  writeFileSync(path, Buffer.concat(parts))
  return path
}

// The tables of rosbag2's schema 4 (Jazzy), filled by the program sqlite3.
function writeSqlite(path, messages, change = (data) => data) {
  const topics = [...new Map(messages.map((message) => [message.topic, message.type]))]
  const sql = [
    'CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);',
    'CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);',
    'CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,' +
      ' serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL, type_description_hash TEXT NOT NULL);',
    'CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL,' +
      ' encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL);',
    'CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL);',
    'CREATE INDEX timestamp_idx ON messages (timestamp ASC);',
    "INSERT INTO schema VALUES(4, 'jazzy');",
    ...topics.map(([name, type], i) => `INSERT INTO topics VALUES(${i + 1}, '${name}', '${longName(type)}', 'cdr', '', '');`),
    'BEGIN;',
    ...messages.map(({ topic, time, data }) => 'INSERT INTO messages(topic_id, timestamp, data) VALUES(' +
      `${topics.findIndex(([name]) => name === topic) + 1}, ${time}, x'${change(data).toString('hex')}');`),
    'COMMIT;'
  ]
  execFileSync('sqlite3', [path], { input: sql.join('\n') })
  return path
}

// What rosbag2 writes beside its files.
function writeMetadata(folder, storage, files, compression = '') {
  const lines = ['rosbag2_bagfile_information:', '  version: 9', `  storage_identifier: ${storage}`,
    '  relative_file_paths:', ...files.map((file) => `    - ${file}`),
    `  compression_format: "${compression}"`, `  compression_mode: "${compression && 'MESSAGE'}"`]
  writeFileSync(join(folder, 'metadata.yaml'), lines.join('\n') + '\n')
  return folder
}

function folderIn(folder, name) {
  mkdirSync(join(folder, name))
  return join(folder, name)
}

function landOn(source, folder) {
  run('land', source, '--output', join(folder, 'out'), '--force')
  const rows = readTable(join(folder, 'out/landing_detections.csv'))
  return rows.map(({ frame, detect_ms, ...rest }) => rest)
}

// Bags by what they are called here.
async function writeBags(recording, folder) {
  const mono = messagesOf(recording, gray('mono8'))
  const at = (name) => join(folder, name)
  const compress = (compression, bytesOf) => ({
    compressChunk: (data) => ({ compression, compressedData: bytesOf(Buffer.from(data)) })
  })
  const half = mono.length >> 1
  const split = folderIn(folder, 'split')
  await writeMcap(join(split, 'split_0.mcap'), mono.slice(0, half))
  await writeMcap(join(split, 'split_1.mcap'), mono.slice(half))
  const packed = folderIn(folder, 'packed')
  writeSqlite(join(packed, 'packed_0.db3'), mono, (data) => Buffer.from(zstd.compress(data, 1)))
  const bags = {
    'mcap': await writeMcap(at('none.mcap'), mono),
    'mcap without chunks': await writeMcap(at('loose.mcap'), mono, { useChunks: false }),
    'mcap without a summary': await writeMcap(at('bare.mcap'), mono, { useChunkIndex: false,
      useStatistics: false, repeatSchemas: false, repeatChannels: false, useMessageIndex: false }),
    'mcap, zstd': await writeMcap(at('zstd.mcap'), mono, compress('zstd', (data) => zstd.compress(data, 1))),
    'mcap, lz4': await writeMcap(at('lz4.mcap'), mono,
      compress('lz4', (data) => execFileSync('lz4', ['-c'], { input: data, maxBuffer: 1 << 24 }))),
    'mcap in two parts': writeMetadata(split, 'mcap', ['split_0.mcap', 'split_1.mcap']),
    'sqlite3': writeSqlite(at('flight.db3'), mono),
    'sqlite3, messages by zstd': writeMetadata(packed, 'sqlite3', ['packed_0.db3'], 'zstd')
  }
  const encodings = {
    '8UC1': gray('8UC1'),
    'bgr8': raw('bgr8', (data) => [data, data, data]),
    'rgb8': raw('rgb8', (data) => [data, data, data]),
    'bgra8': raw('bgra8', (data) => [data, data, data, [255]]),
    'rgba8': raw('rgba8', (data) => [data, data, data, [255]]),
    'yuv422': raw('yuv422', (data) => [128, data]),
    'yuv422_yuy2': raw('yuv422_yuy2', (data) => [data, 128]),
    png
  }
  for (const [name, imageOf] of Object.entries(encodings)) {
    bags[name] = await writeMcap(at(`${name}.mcap`), messagesOf(recording, imageOf))
  }
  return bags
}

async function checkWritten(recording, folder, expected) {
  const bags = await writeBags(recording, folder)
  for (const [name, path] of Object.entries(bags)) {
    expect(JSON.stringify(landOn(path, folder)) === JSON.stringify(expected), `${name}: other results`)
  }
  const lossy = { jpeg: jpg }
  for (const pattern of ['rggb', 'bggr', 'gbrg', 'grbg']) lossy[`bayer_${pattern}8`] = gray(`bayer_${pattern}8`)
  for (const [name, imageOf] of Object.entries(lossy)) {
    const path = writeSqlite(join(folder, `${name}.db3`), messagesOf(recording, imageOf))
    const rows = landOn(path, folder)
    const shifts = rows.map((row, i) =>
      Math.hypot(row.u_px - expected[i].u_px, row.v_px - expected[i].v_px))
    const isClose = rows.length === expected.length && shifts.every((shift) => shift <= TOLERANCE_PX)
    expect(isClose, `${name}: shifted by ${shifts}`)
  }
  return Object.keys(bags).length + Object.keys(lossy).length
}

// The messages of a file, with their topic and the name and definition of their type.
async function readMcap(path) {
  const bytes = readFileSync(path)
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size))
  }
  const decompressHandlers = {
    zstd: (data, size) => zstd.decompress(data, Number(size)),
    lz4: (data, size) => lz4(data, Number(size))
  }
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers })
  const messages = []
  for await (const { channelId, logTime, data } of reader.readMessages()) {
    const channel = reader.channelsById.get(channelId)
    const schema = reader.schemasById.get(channel.schemaId)
    expect(channel.messageEncoding === 'cdr' && schema.encoding === 'ros2msg', `${path}: encodings`)
    const type = shortName(schema.name)
    expect(isOfficial(type, Buffer.from(schema.data).toString()), `${path}: definition of ${type}`)
    messages.push({ time: logTime, topic: channel.topic, type, data })
  }
  return messages
}

function readSqlite(path) {
  const query = 'SELECT name, type, serialization_format AS format, CAST(timestamp AS TEXT) AS time,' +
    ' hex(data) AS data FROM messages JOIN topics ON topics.id = topic_id ORDER BY timestamp, messages.id'
  const rows = JSON.parse(execFileSync('sqlite3', ['-readonly', '-json', path, query], { maxBuffer: 1 << 28 }))
  const check = execFileSync('sqlite3', ['-readonly', path, 'PRAGMA integrity_check']).toString().trim()
  expect(check === 'ok', `${path}: ${check}`)
  return rows.map(({ name, type, format, time, data }) => {
    expect(format === 'cdr', `${path}: is ${format}`)
    return { time: BigInt(time), topic: name, type: shortName(type), data: Buffer.from(data, 'hex') }
  })
}

const isSame = (a, b) => Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z) < 1e-9
// A quaternion and its negative are the same rotation.
const isSameRotation = (a, b) => Math.abs(a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w) > 1 - 1e-9

function checkPoses(name, poses, expected) {
  const areSame = poses.length === expected.length && poses.every(({ position, orientation }, i) =>
    isSame(position, expected[i].pose.position) && isSameRotation(orientation, expected[i].pose.orientation))
  expect(areSame, `${name}: poses`)
}

function checkRead(name, messages, recording) {
  const of = (topic) => messages.filter((message) => message.topic === topic)
    .map(({ time, type, data }) => ({ time, message: decode(type, data) }))
  const same = (a, b, what) => expect(JSON.stringify(a) === JSON.stringify(b), `${name}: ${what}`)
  const images = of('/camera/image_raw')
  same(images.map(({ time }) => `${time}`), recording.frames.map(({ time }) => `${time}`), 'times of images')
  images.forEach(({ time, message }, i) => {
    const { width, height, data } = recording.frames[i].image
    same([message.width, message.height, message.step, message.encoding], [width, height, width, 'mono8'], 'image')
    expect(Buffer.from(message.data).equals(data), `${name}: pixels of image ${i}`)
    expect(timeOf(message.header.stamp) === time, `${name}: stamp of image ${i}`)
  })
  checkPoses(name, of('/pose').map(({ message }) => message.pose), recording.poses)
  const infos = of('/camera/camera_info').map(({ message }) => message)
  same(infos.length, images.length, 'camera_info beside each image')
  same([...infos[0].k], cameraInfoOf(recording).k, 'K')
  same([...infos[0].d], recording.distortion, 'D')
  const { translation, rotation } = of('/tf_static')[0].message.transforms[0].transform
  const mount = mountOf(recording).transform
  expect(isSame(translation, mount.translation), `${name}: place of the mount`)
  expect(isSameRotation(rotation, mount.rotation), `${name}: rotation of the mount`)
}

async function checkConverted(recording, flight, folder) {
  const kinds = [['none.mcap', readMcap], ['lz4.mcap', readMcap], ['zstd.mcap', readMcap], ['none.db3', readSqlite]]
  for (const [name, read] of kinds) {
    const path = join(folder, `kestrel_${name}`)
    run('convert', flight, path, '--compression', name.split('.')[0])
    checkRead(name, await read(path), recording)
  }
  return kinds.length
}

const folder = mkdtempSync(join(tmpdir(), 'kestrel-rosbag2-'))
try {
  await Promise.all([zstd.isLoaded, lz4.isLoaded])
  const flight = join(folder, 'flight')
  const recording = simulate(kestrel, flight, 8, 10)
  for (const frame of recording.frames) frame.image = readGrayPng(frame.path)
  const expected = landOn(flight, folder)
  expect(expected.length === 8 && expected.every((row) => row.detected === '1'), 'the pattern is found')
  const written = await checkWritten(recording, folder, expected)
  const read = await checkConverted(recording, flight, folder)
  console.log(`${written} bags of others read, ${read} bags of Kestrel read by others`)
} finally {
  rmSync(folder, { recursive: true })
}
finish()
