// SPDX-License-Identifier: BSD-3-Clause
// What the checks of bags and of DDS share: the messages of ROS 2 by @foxglove/rosmsg2-serialization
// with the official definitions that @foxglove/rosmsg-msgs-common ships, and a recording folder read
// without Kestrel.
import { execFileSync } from 'node:child_process'
import { readFileSync } from 'node:fs'
import { createRequire } from 'node:module'
import { join } from 'node:path'
import { inflateSync } from 'node:zlib'

const require = createRequire(import.meta.url)
const { parse } = require('@foxglove/rosmsg')
const { ros2humble } = require('@foxglove/rosmsg-msgs-common')
const { MessageReader, MessageWriter } = require('@foxglove/rosmsg2-serialization')

// Fields of those that @foxglove/rosmsg-msgs-common has not: vision_msgs 4, rmw_dds_common of Iron.
const MORE = parse(`
std_msgs/Header header
vision_msgs/Detection3D[] detections
================================================================================
MSG: vision_msgs/Detection3D
std_msgs/Header header
vision_msgs/ObjectHypothesisWithPose[] results
vision_msgs/BoundingBox3D bbox
string id
================================================================================
MSG: vision_msgs/ObjectHypothesisWithPose
vision_msgs/ObjectHypothesis hypothesis
geometry_msgs/PoseWithCovariance pose
================================================================================
MSG: vision_msgs/ObjectHypothesis
string class_id
float64 score
================================================================================
MSG: vision_msgs/BoundingBox3D
geometry_msgs/Pose center
geometry_msgs/Vector3 size
================================================================================
MSG: rmw_dds_common/Gid
uint8[16] data
================================================================================
MSG: rmw_dds_common/NodeEntitiesInfo
string<=256 node_namespace
string<=256 node_name
rmw_dds_common/Gid[] reader_gid_seq
rmw_dds_common/Gid[] writer_gid_seq
================================================================================
MSG: rmw_dds_common/ParticipantEntitiesInfo
rmw_dds_common/Gid gid
rmw_dds_common/NodeEntitiesInfo[] node_entities_info_seq
`, { ros2: true, skipTypeFixup: true })
MORE[0].name = 'vision_msgs/Detection3DArray'

const known = new Map([...Object.values(ros2humble), ...MORE].map((each) => [each.name, each]))
const listOf = (type) => [known.get(type), ...known.values()]

const made = new Map()
function once(kind, type) {
  const key = `${kind.name} ${type}`
  if (!made.has(key)) made.set(key, new kind(listOf(type)))
  return made.get(key)
}

// By the short name of a type: "sensor_msgs/Image".
export const encode = (type, message) => once(MessageWriter, type).writeMessage(message)
export const decode = (type, bytes) => once(MessageReader, type).readMessage(bytes)
export const longName = (type) => type.replace('/', '/msg/')
export const shortName = (type) => type.replace('/msg/', '/')

// Whether a definition, as a bag has it, says the same as the official one, constants aside.
export function isOfficial(type, text) {
  const fieldsOf = ({ name, definitions }) => [name, definitions
    .filter((field) => !field.isConstant)
    .map(({ type, name, isArray, arrayLength }) => [type, name, isArray, arrayLength])]
  const [first, ...rest] = parse(text, { ros2: true })
  return [{ ...first, name: type }, ...rest].every((each) =>
    JSON.stringify(fieldsOf(each)) === JSON.stringify(fieldsOf(known.get(each.name))))
}

// 'time' in ns, BigInt.
export const stampOf = (time) =>
  ({ sec: Number(time / 1000000000n), nanosec: Number(time % 1000000000n) })
export const timeOf = ({ sec, nanosec }) => BigInt(sec) * 1000000000n + BigInt(nanosec)

// The gray values of a PNG file of 8 bits a pixel that is not interlaced, as Kestrel's simulator
// writes it.
export function readGrayPng(path) {
  const file = readFileSync(path)
  const [width, height] = [file.readUInt32BE(16), file.readUInt32BE(20)]
  if (file[24] !== 8 || file[25] !== 0 || file[28] !== 0) throw new Error(`${path}: is not gray`)
  const parts = []
  for (let at = 8; at < file.length;) {
    const size = file.readUInt32BE(at)
    if (file.toString('latin1', at + 4, at + 8) === 'IDAT') parts.push(file.subarray(at + 8, at + 8 + size))
    at += size + 12
  }
  const rows = inflateSync(Buffer.concat(parts))
  const data = Buffer.alloc(width * height)
  for (let y = 0; y < height; ++y) {
    const filter = rows[y * (width + 1)]
    for (let x = 0; x < width; ++x) {
      const left = x > 0 ? data[y * width + x - 1] : 0
      const above = y > 0 ? data[(y - 1) * width + x] : 0
      const corner = x > 0 && y > 0 ? data[(y - 1) * width + x - 1] : 0
      const value = rows[y * (width + 1) + 1 + x]
      data[y * width + x] = value + predicted(filter, left, above, corner)
    }
  }
  return { width, height, data }
}

function predicted(filter, left, above, corner) {
  if (filter < 3) return [0, left, above][filter]
  if (filter === 3) return (left + above) >> 1
  const [p, q, r] = [left, above, corner].map((value) => Math.abs(left + above - corner - value))
  return p <= q && p <= r ? left : q <= r ? above : corner
}

// A recording folder of `kestrel simulate`: frames, poses, and the camera's calibration.
export function readRecording(folder) {
  const rowsOf = (name) => readFileSync(join(folder, 'mav0', name), 'utf8').trim().split('\n')
    .filter((row) => !row.startsWith('#')).map((row) => row.split(','))
  const yaml = readFileSync(join(folder, 'mav0/cam0/sensor.yaml'), 'utf8')
  const listOf = (key) => yaml.match(new RegExp(`${key}: *\\[([^\\]]*)\\]`))[1].split(',').map(Number)
  const frames = rowsOf('cam0/data.csv').map(([time, name]) =>
    ({ time: BigInt(time), path: join(folder, 'mav0/cam0/data', name) }))
  const poses = rowsOf('nav0/data.csv').map(([time, x, y, z, qw, qx, qy, qz]) => ({
    time: BigInt(time),
    pose: {
      position: { x: Number(x), y: Number(y), z: Number(z) },
      orientation: { x: Number(qx), y: Number(qy), z: Number(qz), w: Number(qw) }
    }
  }))
  return {
    frames,
    poses,
    size: listOf('resolution'),
    intrinsics: listOf('intrinsics'),
    distortion: listOf('distortion_coefficients'),
    model: yaml.match(/distortion_model: *(\S+)/)[1],
    bodyFromCamera: listOf('data')
  }
}

export function cameraInfoOf({ size, intrinsics: [fx, fy, cx, cy], distortion, model }, header) {
  return {
    header,
    width: size[0],
    height: size[1],
    distortion_model: model === 'equidistant' ? model : 'plumb_bob',
    d: distortion,
    k: [fx, 0, cx, 0, fy, cy, 0, 0, 1],
    r: [1, 0, 0, 0, 1, 0, 0, 0, 1],
    p: [fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0],
    binning_x: 0,
    binning_y: 0,
    roi: { x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false }
  }
}

// The mount as a static transform. The rotation is about its largest axis.
export function mountOf({ bodyFromCamera: m }, header, child) {
  const at = (row, column) => m[4 * row + column]
  const i = [0, 1, 2].reduce((most, axis) => at(axis, axis) > at(most, most) ? axis : most, 0)
  const [j, k] = [(i + 1) % 3, (i + 2) % 3]
  const root = Math.sqrt(1 + at(i, i) - at(j, j) - at(k, k))
  const q = []
  q[i] = root / 2
  q[j] = (at(j, i) + at(i, j)) / (2 * root)
  q[k] = (at(k, i) + at(i, k)) / (2 * root)
  return {
    header,
    child_frame_id: child,
    transform: {
      translation: { x: at(0, 3), y: at(1, 3), z: at(2, 3) },
      rotation: { x: q[0], y: q[1], z: q[2], w: (at(k, j) - at(j, k)) / (2 * root) }
    }
  }
}

// A simulated landing that is quickly rendered.
export function simulate(kestrel, folder, frames, rate) {
  execFileSync(kestrel, ['simulate', 'landing', '--scenario', 'calm', '--seed', '2', '--output', folder,
    '--set', `frames=${frames}`, '--set', `rate_hz=${rate}`, '--set', 'ground.map_px=256',
    '--set', 'shutter.rays_per_pixel=4'], { stdio: ['ignore', 'ignore', 'pipe'] })
  return readRecording(folder)
}

// The rows of a table by their columns.
export function readTable(path) {
  const [head, ...rows] = readFileSync(path, 'utf8').trim().split('\n').map((row) => row.split(','))
  return rows.map((row) => Object.fromEntries(head.map((name, i) => [name, row[i]])))
}
