// SPDX-License-Identifier: BSD-3-Clause
// Watches how old the data are, and is heard and felt when they become too old.
import { connection } from "./connection";
import { isSame, stalenessOf, type Staleness } from "./freshness";
import { store } from "./store";

const looksPerSecond = 10;
const repeatMs = 5000;
/** So long without a message, the network may have lost the connection without a word. */
const reconnectMs = 4000;

let sound: AudioContext | null = null;
let soundedAt = -Infinity;

/** Browsers allow sound only after somebody has touched the page. */
function allowSound(): void {
  sound ??= new AudioContext();
  void sound.resume();
}

export function startAlarm(): void {
  addEventListener("pointerdown", allowSound, { once: true });
  addEventListener("keydown", allowSound, { once: true });
  setInterval(look, 1000 / looksPerSecond);
}

function look(): void {
  const { freshness, staleness, hello, status } = store.state;
  const now = performance.now();
  const isLive = hello?.live ?? false;
  const next = stalenessOf(freshness, isLive, now);
  if ((freshness.silence(now) ?? 0) > reconnectMs) connection.renew();
  if (!isSame(next, staleness)) store.set({ staleness: next });
  if (isLive && !status?.over && isAlarming(next)) sayOften(now);
}

function isAlarming(staleness: Staleness): boolean {
  return staleness.isSilent || staleness.old.length > 0;
}

function sayOften(now: number): void {
  if (store.state.isMuted || now - soundedAt < repeatMs) return;
  soundedAt = now;
  if (navigator.userActivation.hasBeenActive) navigator.vibrate?.([300, 100, 300]);
  if (sound?.state === "running") beep(sound);
}

function beep(context: AudioContext): void {
  const tone = context.createOscillator();
  const volume = context.createGain();
  volume.gain.value = 0.3;
  tone.type = "square";
  tone.frequency.setValueAtTime(880, context.currentTime);
  tone.frequency.setValueAtTime(660, context.currentTime + 0.25);
  tone.connect(volume).connect(context.destination);
  tone.start();
  tone.stop(context.currentTime + 0.5);
}
