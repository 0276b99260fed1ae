// SPDX-License-Identifier: BSD-3-Clause
// What all checks share: what is not as it should be, and a flight.
const failures = []
export const expect = (holds, what) => { if (!holds) failures.push(what) }

// Prints that, and ends with status 1 if there is anything.
export function finish() {
  for (const failure of new Set(failures)) console.error(failure)
  process.exit(failures.length === 0 ? 0 : 1)
}

// A simulated landing from a low altitude, in small images.
export const FLIGHT = ['fly', 'sim:standing', '--autopilot', 'sim:px4', '--set',
  'fly.sim_autopilot.pilot.start_altitude_m=4', '--set', 'fly.sim_camera.scale=0.4']
