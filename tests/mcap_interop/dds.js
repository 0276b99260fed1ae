// SPDX-License-Identifier: BSD-3-Clause
// Usage: node dds.js KESTREL FAST_DDS_PEER. A whole simulated flight over DDS: its messages, received
// by Fast DDS as raw bytes, decoded by @foxglove/rosmsg2-serialization with the official definitions
// and compared with the flight's table; and what the node says of itself. Then the other way: images,
// calibration, poses and mount, encoded by the same and published by Fast DDS, are what `kestrel fly
// dds:...` flies by.
import { execFileSync, spawn } from 'node:child_process'
import { mkdtempSync, rmSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { setTimeout as pause } from 'node:timers/promises'
import { Peer, ddsType } from './dds_peer.js'
import { expect, finish, FLIGHT } from './checks.js'
import { cameraInfoOf, decode, encode, mountOf, readGrayPng, readTable, simulate, stampOf,
  timeOf } from './ros2.js'

const [kestrel, peerProgram] = process.argv.slice(2)
const PATIENCE_MS = 60000
const RESULTS = [
  ['rt/kestrel/detections', 'vision_msgs/Detection3DArray', 'reliable'],
  ['rt/kestrel/target_pose', 'geometry_msgs/PoseWithCovarianceStamped', 'reliable'],
  ['rt/kestrel/track', 'nav_msgs/Odometry', 'reliable'],
  ['rt/kestrel/prediction', 'nav_msgs/Path', 'reliable'],
  ['rt/kestrel/markers', 'visualization_msgs/MarkerArray', 'reliable'],
  ['rt/kestrel/image_annotated', 'sensor_msgs/Image', 'best_effort'],
  ['rt/tf', 'tf2_msgs/TFMessage', 'reliable'],
  ['rt/tf_static', 'tf2_msgs/TFMessage', 'kept'],
  ['rt/diagnostics', 'diagnostic_msgs/DiagnosticArray', 'reliable']
]
const NODE_INFO = ['ros_discovery_info', 'rmw_dds_common/ParticipantEntitiesInfo', 'kept']
// As `ros2 topic info -v` of Jazzy shows them.
const HASHES = {
  'vision_msgs/Detection3DArray': 'RIHS01_793f5eab9595ac1c0da07873cc859db42eae51f0ee76056db8562515d830e018',
  'visualization_msgs/MarkerArray': 'RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf',
  'sensor_msgs/Image': 'RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47',
  'rmw_dds_common/ParticipantEntitiesInfo': 'RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e'
}

async function newPeer(topics) {
  const peer = new Peer(peerProgram)
  await peer.ready
  for (const topic of topics) peer.read(...topic)
  return peer
}

// Starts `kestrel`, which finds 'peer' alone.
function start(peer, args) {
  const program = spawn(kestrel, [...args, '--dds', peer.domain],
    { stdio: ['ignore', 'ignore', 'pipe'], env: { ...process.env, CYCLONEDDS_URI: peer.uri } })
  const run = { program, said: '' }
  program.stderr.on('data', (text) => { run.said += text })
  run.ended = new Promise((resolve) => program.on('exit', resolve))
  return run
}

// Decodes all that a topic has; what is encoded again is the same to the byte.
function decoded(peer, [topic, type]) {
  return peer.messages.get(topic).map((bytes) => {
    const message = decode(type, bytes)
    expect(Buffer.from(encode(type, message)).equals(bytes), `${topic}: other bytes when encoded again`)
    return message
  })
}

const isNear = (a, b) => Math.abs(a - b) < 2e-6 // the table has 1e-6

// Compares them with the rows of the table; returns by how much, the same in all of them, the stamps
// are ahead of it, ns.
function checkDetections(messages, rows) {
  expect(messages.length >= 0.9 * rows.length, `${messages.length} messages of ${rows.length} frames`)
  const last = messages.at(-1)
  const ahead = timeOf(last.header.stamp) - BigInt(rows.at(-1).timestamp_ns)
  const byTime = new Map(rows.map((row) => [BigInt(row.timestamp_ns) + ahead, row]))
  for (const { header, detections } of messages) {
    const row = byTime.get(timeOf(header.stamp))
    expect(row, 'detections: a stamp that the table has not')
    expect(header.frame_id === 'camera_optical_frame', `detections: frame ${header.frame_id}`)
    expect(detections.length === Number(row?.detected), `detections: ${detections.length}, ${row?.detected}`)
    if (detections.length === 0 || !row) continue
    const { hypothesis, pose } = detections[0].results[0]
    const { x, y, z } = pose.pose.position
    expect(hypothesis.class_id === 'landing_pattern', `detections: ${hypothesis.class_id}`)
    expect(isNear(x, row.p_CP_C_x_m) && isNear(y, row.p_CP_C_y_m) && isNear(z, row.p_CP_C_z_m),
      'detections: another position than in the table')
  }
  return ahead
}

function checkTrack(messages, rows, ahead) {
  const byTime = new Map(rows.map((row) => [BigInt(row.timestamp_ns) + ahead, row]))
  for (const { header, child_frame_id, pose, twist } of messages) {
    const row = byTime.get(timeOf(header.stamp))
    const { x, y, z } = pose.pose.position
    expect(row && isNear(x, row.p_x_m) && isNear(y, row.p_y_m) && isNear(z, row.p_z_m),
      'track: another position than in the table')
    expect(header.frame_id === 'map' && child_frame_id === 'landing_target', 'track: frames')
    expect(!row || isNear(twist.twist.linear.z, row.v_z_mps), 'track: another velocity')
  }
}

// What the specifications of ROS 2 say that a participant and its endpoints tell of themselves.
function checkDiscovery(peer) {
  const found = [...peer.entities].map(([gid, entity]) => ({ gid, ...entity }))
  const participant = found.find(({ kind }) => kind === 'participant')
  expect(participant?.userData === 'enclave=/;', `participant: ${participant?.userData}`)
  for (const [topic, type] of [...RESULTS, NODE_INFO]) {
    const writer = found.find((entity) => entity.kind === 'writer' && entity.topic === topic)
    expect(writer?.type === ddsType(type), `${topic}: type ${writer?.type}`)
    expect(/^typehash=RIHS01_[0-9a-f]{64};$/.test(writer?.userData), `${topic}: ${writer?.userData}`)
    const hash = HASHES[type] ?? writer?.userData.slice('typehash='.length, -1)
    expect(writer?.userData === `typehash=${hash};`, `${topic}: ${writer?.userData}`)
  }
  const { gid, node_entities_info_seq: [node, ...others] } = decoded(peer, NODE_INFO).at(-1)
  const hexadecimal = ({ data }) => Buffer.from(data).toString('hex')
  const listed = (gids) => gids.map(hexadecimal).sort().join()
  const ofKind = (wanted) => found.filter(({ kind, topic }) => kind === wanted && topic.startsWith('rt/'))
    .map((entity) => entity.gid).sort().join()
  expect(hexadecimal(gid) === participant?.gid, 'ros_discovery_info: Gid of the participant')
  expect(node.node_namespace === '/' && node.node_name === 'kestrel', 'ros_discovery_info: name')
  expect(listed(node.reader_gid_seq) === ofKind('reader'), 'ros_discovery_info: readers')
  expect(listed(node.writer_gid_seq) === ofKind('writer'), 'ros_discovery_info: writers')
  expect(others.length === 0, 'ros_discovery_info: one node')
}

async function checkHeard(folder) {
  const peer = await newPeer([...RESULTS, NODE_INFO])
  const output = join(folder, 'flown')
  const run = start(peer, [...FLIGHT, '--output', output])
  const status = await run.ended
  expect(status === 0, `the flight ended with ${status}: ${run.said}`)
  await peer.end()
  const messages = new Map(RESULTS.map((topic) => [topic[0], decoded(peer, topic)]))
  for (const [topic] of RESULTS) expect(messages.get(topic).length > 0, `${topic}: nothing was heard`)
  const rows = readTable(join(output, 'landing_detections.csv'))
  const heard = messages.get('rt/kestrel/detections')
  const ahead = checkDetections(heard, rows)
  checkTrack(messages.get('rt/kestrel/track'), readTable(join(output, 'landing_track.csv')), ahead)
  checkDiscovery(peer)
  const count = [...messages.values()].reduce((sum, each) => sum + each.length, 0)
  console.log(`${count} messages of a flight of ${rows.length} frames decoded`)
}

// Publishes a recording as a system of ROS 2 would, again and again, as if it were now.
class RosSystem {
  constructor(peer, recording) {
    this.peer = peer
    this.recording = recording
    this.frameAt = new Map() // index of the frame by its stamp, ns
    const header = { stamp: stampOf(0n), frame_id: 'base_link' }
    this.#write('rt/tf_static', 'tf2_msgs/TFMessage', 'kept',
      { transforms: [mountOf(recording, header, 'camera')] })
  }

  async run(isOver) {
    const { frames, poses } = this.recording
    const span = poses.at(-1).time - poses[0].time
    const start = BigInt(Date.now()) * 1000000n
    for (let turn = 0n; !isOver(); ++turn) {
      const shift = start + turn * span - poses[0].time
      const events = [...poses, ...frames].sort((a, b) => Number(a.time - b.time))
      for (const event of events) {
        const time = event.time + shift
        await pause(Math.max(0, Number(time / 1000000n) - Date.now()))
        if (isOver()) return
        if (event.pose) this.#writePose(time, event)
        else this.#writeFrame(time, event, frames.indexOf(event))
      }
    }
  }

  #write(topic, type, qos, message) {
    this.peer.write(topic, type, qos, Buffer.from(encode(type, message)))
  }
  #writePose(time, { pose }) {
    this.#write('rt/odom', 'nav_msgs/Odometry', 'reliable', {
      header: { stamp: stampOf(time), frame_id: 'odom' },
      child_frame_id: 'base_link',
      pose: { pose, covariance: new Float64Array(36) },
      twist: { covariance: new Float64Array(36) }
    })
  }
  #writeFrame(time, { image }, index) {
    const header = { stamp: stampOf(time), frame_id: 'camera' }
    this.#write('rt/camera/camera_info', 'sensor_msgs/CameraInfo', 'reliable',
      cameraInfoOf(this.recording, header))
    const { width, height, data } = image
    this.#write('rt/camera/image_raw', 'sensor_msgs/Image', 'reliable',
      { header, height, width, encoding: 'mono8', is_bigendian: 0, step: width, data })
    this.frameAt.set(time, index)
  }
}

async function checkSaid(folder) {
  const wanted = 15
  const flight = join(folder, 'flight')
  const recording = simulate(kestrel, flight, 20, 10)
  for (const frame of recording.frames) frame.image = readGrayPng(frame.path)
  const land = ['land', flight, '--output', join(folder, 'land')]
  execFileSync(kestrel, land, { stdio: ['ignore', 'ignore', 'pipe'] })
  const expected = readTable(join(folder, 'land/landing_detections.csv'))

  const poses = ['rt/kestrel/target_pose', 'geometry_msgs/PoseWithCovarianceStamped', 'reliable']
  const peer = await newPeer([poses])
  const system = new RosSystem(peer, recording)
  const run = start(peer, ['fly', 'dds:/camera/image_raw', '--output', join(folder, 'used')])
  let hasEnded = false
  run.ended.then(() => { hasEnded = true })
  const end = Date.now() + PATIENCE_MS
  await system.run(() => hasEnded || Date.now() > end || peer.messages.get(poses[0]).length >= wanted)
  run.program.kill('SIGINT')
  const status = await run.ended
  expect(status === 0, `dds: the flight ended with ${status}: ${run.said}`)
  await peer.end()

  const heard = decoded(peer, poses)
  expect(heard.length >= wanted, `dds: ${heard.length} poses of the target: ${run.said}`)
  let worst = 0
  for (const { header, pose } of heard) {
    const row = expected[system.frameAt.get(timeOf(header.stamp))]
    expect(row, 'dds: a pose of a frame that was not published')
    if (!row) continue
    const { x, y, z } = pose.pose.position
    worst = Math.max(worst, Math.hypot(x - row.p_CP_C_x_m, y - row.p_CP_C_y_m, z - row.p_CP_C_z_m))
  }
  expect(worst < 0.02, `dds: the target is ${worst} m from where kestrel land has it`)
  console.log(`${heard.length} poses of the target by images of others, within ${(1e3 * worst).toFixed(1)} mm`)
}

const folder = mkdtempSync(join(tmpdir(), 'kestrel-dds-'))
try {
  await checkHeard(folder)
  await checkSaid(folder)
} finally {
  rmSync(folder, { recursive: true })
}
finish()
