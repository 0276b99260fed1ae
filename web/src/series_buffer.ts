// SPDX-License-Identifier: BSD-3-Clause
import { secondsBetween, type RecordedSeries, type Sample } from "./protocol";

/** The samples of the last while, as columns: time (s since the first one) and each series. */
export class SeriesBuffer {
  readonly columns: (number | null)[][];
  private origin: string | null = null;

  constructor(
    private readonly seriesCount: number,
    private readonly spanSeconds = 60,
  ) {
    this.columns = Array.from({ length: seriesCount + 1 }, () => []);
  }

  static ofRecording({ times_ms, values }: RecordedSeries): SeriesBuffer {
    const buffer = new SeriesBuffer(values.length, Infinity);
    [times_ms.map((time) => time / 1000), ...values].forEach((column, i) => buffer.columns[i]!.push(...column));
    return buffer;
  }

  /** Samples of a time before the newest begin anew, as when a recording is wound back. */
  add(sample: Sample): void {
    this.origin ??= sample.time;
    const time = secondsBetween(this.origin, sample.time);
    if (time < (this.newestTime() ?? time)) this.clear();
    this.columns[0]!.push(time);
    for (let i = 0; i < this.seriesCount; i++) this.columns[i + 1]!.push(sample.values[i] ?? null);
    this.forgetBefore(time - this.spanSeconds);
  }

  newestTime(): number | null {
    return this.columns[0]!.at(-1) ?? null;
  }

  /** The newest value of a series; null where it is not known. */
  newest(series: number): number | null {
    return this.columns[series + 1]?.at(-1) ?? null;
  }

  private clear(): void {
    for (const column of this.columns) column.length = 0;
  }

  // A tenth more is kept, so that not every sample moves all the others.
  private forgetBefore(time: number): void {
    const times = this.columns[0]!;
    if (times[0]! > time - 0.1 * this.spanSeconds) return;
    const first = times.findIndex((t) => t! >= time);
    for (const column of this.columns) column.splice(0, first);
  }
}
