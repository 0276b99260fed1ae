// SPDX-License-Identifier: BSD-3-Clause
import { useEffect, useState } from "preact/hooks";
import { store, type State } from "./store";

/** A part of the state; the component is drawn anew when that part is another one. */
export function useStore<T>(select: (state: State) => T): T {
  const [, redraw] = useState<T>(() => select(store.state));
  useEffect(() => store.subscribe(() => redraw(select(store.state))), []);
  return select(store.state);
}

/** Draws the component anew so many times a second: for what changes with the clock. */
export function useClock(timesPerSecond: number): void {
  const [, redraw] = useState(0);
  useEffect(() => {
    const timer = setInterval(() => redraw((count) => count + 1), 1000 / timesPerSecond);
    return () => clearInterval(timer);
  }, [timesPerSecond]);
}
