// SPDX-License-Identifier: BSD-3-Clause
// Ages of the data of a flight. Nothing old is shown as what is now.
import type { Sources, SourceName } from "./protocol";

/** Older than this, data of a flight are not what is now, ms. */
export const freshMs = 1000;

/** A recording says nothing while it is held, ms. */
const quietMs = 3000;

/** Most that the clocks of two computers drift apart, of the time that passes. */
const maxDrift = 2e-4;

/** The age of the newest message, and of the newest data of each source, by the page's clock (ms). */
export class Freshness {
  private heardAt: number | null = null;
  /** When the newest data of a source were made; null: it has given none yet. */
  private readonly madeAt = new Map<SourceName, number | null>();
  /** The page's clock minus the program's, and the way of the quickest message. */
  private offset: { value: number; at: number } | null = null;

  hear(now: number): void {
    this.heardAt = now;
  }

  /** Takes the ages in a message; they grow by the time that it was on its way. */
  tell(message: Sources, now: number): void {
    const sent = Number(BigInt(message.time) / 1000n) / 1000;
    const last = this.offset;
    const drifted = last === null ? Infinity : last.value + maxDrift * (now - last.at);
    this.offset = { value: Math.min(now - sent, drifted), at: now };
    this.madeAt.clear();
    for (const { name, age_ms } of message.sources) {
      this.madeAt.set(name, age_ms === null ? null : sent + this.offset.value - age_ms);
    }
  }

  /** Since the last message; null before the first. */
  silence(now: number): number | null {
    return this.heardAt === null ? null : now - this.heardAt;
  }

  /** Age of the newest data of a source; null where it has given none yet, or is not known. */
  age(source: SourceName, now: number): number | null {
    const madeAt = this.madeAt.get(source) ?? null;
    return madeAt === null ? null : Math.max(now - madeAt, 0);
  }

  get sources(): SourceName[] {
    return [...this.madeAt.keys()];
  }
}

/** The sources that are too old. */
export interface Staleness {
  isSilent: boolean;
  /** Sources whose last data are old. */
  old: SourceName[];
  /** Sources with fresh data. */
  fresh: SourceName[];
  /** Sources that have given nothing yet. */
  missing: SourceName[];
}

export function stalenessOf(freshness: Freshness, isLive: boolean, now: number): Staleness {
  const silence = freshness.silence(now);
  const isSilent = silence !== null && silence > (isLive ? freshMs : quietMs);
  const { sources } = freshness;
  const age = (source: SourceName) => freshness.age(source, now);
  const isFresh = (source: SourceName) => !isSilent && (age(source) ?? Infinity) <= freshMs;
  return {
    isSilent,
    old: sources.filter((source) => age(source) !== null && !isFresh(source)),
    fresh: sources.filter(isFresh),
    missing: sources.filter((source) => age(source) === null),
  };
}

export function isSame(one: Staleness, other: Staleness): boolean {
  return JSON.stringify(one) === JSON.stringify(other);
}

const silenceOf: Record<SourceName, string> = {
  frames: "No images",
  autopilot: "Autopilot silent",
  pose: "No pose",
};

/** As "No images for 3 s". */
export function silenceInWords(source: SourceName | null, age: number | null): string {
  const what = source === null ? "No data" : silenceOf[source];
  return age === null ? what : `${what} for ${(age / 1000).toFixed(0)} s`;
}
