// SPDX-License-Identifier: BSD-3-Clause
import { useEffect, useState } from "preact/hooks";
import type { SourceName } from "./protocol";
import { isFresh, store, type State } from "./store";

/** A part of the state; the component is drawn anew when that part is another one. */
export function useStore<T>(select: (state: State) => T, isSame: (one: T, other: T) => boolean = Object.is): T {
  const [, redraw] = useState<T>(() => select(store.state));
  useEffect(
    () =>
      store.subscribe(() =>
        redraw((before) => {
          const now = select(store.state);
          return isSame(before, now) ? before : now;
        }),
      ),
    [],
  );
  return select(store.state);
}

/** Whether values that come from these sources are what is now. */
export function useFresh(sources: SourceName[]): boolean {
  return useStore((state) => isFresh(state, sources));
}

/** Draws the component anew so many times a second: for what changes with the clock. */
export function useClock(timesPerSecond: number): void {
  const [, redraw] = useState(0);
  useEffect(() => {
    const timer = setInterval(() => redraw((count) => count + 1), 1000 / timesPerSecond);
    return () => clearInterval(timer);
  }, [timesPerSecond]);
}
