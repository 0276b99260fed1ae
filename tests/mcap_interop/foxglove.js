// SPDX-License-Identifier: BSD-3-Clause
// What the checks of a file and of a live flight share: the messages as Foxglove knows them.
import { createRequire } from 'node:module'
import protobuf from 'protobufjs'
import 'protobufjs/ext/descriptor/index.js'
import { expect } from './checks.js'

const require = createRequire(import.meta.url)
const { foxgloveEnumSchemas, foxgloveMessageSchemas, generateProto } =
  require('@foxglove/schemas/internal')
const { FileDescriptorSet } = require('protobufjs/ext/descriptor')

export const EXPECTED = ['CameraCalibration', 'CompressedImage', 'FrameTransforms', 'ImageAnnotations',
  'Log', 'PoseInFrame', 'SceneUpdate'].map((name) => `foxglove.${name}`).concat('kestrel.FrameResult')

const nanoseconds = ({ seconds, nanos }) => BigInt(seconds.toString()) * 1000000000n + BigInt(nanos)

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

const theirs = foxgloveRoot()

// The type of a message by its schema, a serialized FileDescriptorSet, whose parts Foxglove knows.
export function typeOf(schema, name) {
  const root = protobuf.Root.fromDescriptor(FileDescriptorSet.decode(schema)).resolveAll()
  const foxglove = root.lookup('foxglove')
  if (foxglove) compareTypes(foxglove, theirs)
  return root.lookupType(name)
}

// The time that is in a message, ns; nothing when it has none.
export function timeIn(decoded) {
  const stamp = decoded.timestamp ?? decoded.transforms?.[0].timestamp ??
    decoded.points?.[0]?.timestamp ?? decoded.entities?.[0]?.timestamp
  return stamp && nanoseconds(stamp)
}

// The times of all frames, ns.
export function timesOf(table) {
  return table.trim().split('\n').slice(1).map((row) => BigInt(row.split(',')[1]))
}
