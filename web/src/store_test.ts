// SPDX-License-Identifier: BSD-3-Clause
import { describe, expect, test } from "vitest";
import { secondsBetween, unpackImage, type Hello, type MapMessage } from "./protocol";
import { SeriesBuffer } from "./series_buffer";
import { stalenessOf } from "./freshness";
import { initialState, isFresh, Store, store, withMessage } from "./store";
import { turnView } from "./actions";

const hello: Hello = {
  kind: "hello",
  title: "test",
  live: true,
  series: [{ name: "height", unit: "m", label: "Height", sources: ["frames"], is_count: false }],
  layers: [],
  views: [],
  offers: [],
  exports: false,
  colors: false,
};

function mapAt(x: number): MapMessage {
  return {
    kind: "map",
    uav: [x, 0],
    heading: 0,
    target: null,
    velocity: [0, 0],
    prediction: [],
    objects: [],
    mapped: [],
  };
}

describe("store", () => {
  test("what a flight said last stays until another server begins", () => {
    const over = { kind: "status", state: "flight over", reason: "landed", recording: false, over: true, replay: "" } as const;
    let state = withMessage(withMessage(initialState(), hello), over);
    state = { ...state, connection: "lost" };
    expect(state.status?.over).toBe(true);
    expect(withMessage(state, hello).status).toBeNull();
  });

  test("a server that comes back begins anew", () => {
    let state = withMessage(initialState(), hello);
    state = withMessage(state, { kind: "event", time: "1", level: "info", text: "old" });
    state = withMessage(state, { kind: "sample", time: "1", values: [3] });
    state = withMessage(state, hello);
    expect(state.events).toEqual([]);
    expect(state.series.newest(0)).toBeNull();
  });

  test("after a reconnection nothing is what is now until fresh data come", () => {
    const status = { kind: "status", state: "tracking", reason: "", recording: false, over: false, replay: "" } as const;
    const state = withMessage(withMessage({ ...initialState(), connection: "open" }, hello), status);
    const settled = { ...state, staleness: stalenessOf(state.freshness, true, performance.now()) };
    expect(isFresh(settled, ["frames"])).toBe(false);
    withMessage(state, { kind: "sources", time: "5000000000", sources: [{ name: "frames", age_ms: 20 }] });
    const fresh = { ...state, staleness: stalenessOf(state.freshness, true, performance.now()) };
    expect(isFresh(fresh, ["frames"])).toBe(true);
    expect(isFresh(fresh, ["frames", "pose"])).toBe(false);
    expect(isFresh({ ...fresh, connection: "lost" }, ["frames"])).toBe(false);
    expect(isFresh({ ...fresh, status: { ...status, over: true } }, ["frames"])).toBe(false);
    expect(isFresh(withMessage(fresh, hello), ["frames"])).toBe(false);
  });

  test("what a recording has is what is shown, however long it is held", () => {
    expect(isFresh(withMessage(initialState(), { ...hello, live: false }), ["frames", "pose"])).toBe(true);
  });

  test("a recording has its plots at once, until another is opened", () => {
    const series = { kind: "series", times_ms: [0, 500], values: [[3, null]] } as const;
    const timeline = { kind: "timeline", begin: "0", times_ms: [0, 500], marks: "f-" } as const;
    const state = withMessage(initialState(), { ...series, times_ms: [...series.times_ms], values: [[3, null]] });
    expect(state.flight?.columns).toEqual([[0, 0.5], [3, null]]);
    expect(withMessage(state, { ...timeline, times_ms: [0, 500] }).flight).toBeNull();
  });

  test("a view that the new server does not have is given up", () => {
    const views = ["threshold 1/8", "threshold 1/4"];
    const state = { ...withMessage(initialState(), { ...hello, views }), view: "threshold 1/4" };
    expect(withMessage(state, { ...hello, views }).view).toBe("threshold 1/4");
    expect(withMessage(state, { ...hello, views: ["segmentation"] }).view).toBe("");
  });

  test("views follow each other round and round", () => {
    store.receive({ ...hello, views: ["segmentation", "threshold"] });
    const seen = [1, 1, 1, -1, -1].map((direction) => {
      turnView(direction as 1 | -1);
      return store.state.view;
    });
    expect(seen).toEqual(["segmentation", "threshold", "", "threshold", "segmentation"]);
  });

  test("the way on the map is bounded, and only of moves", () => {
    let state = initialState();
    for (let i = 0; i < 1000; i++) state = withMessage(state, mapAt(i));
    expect(state.track.length).toBe(600);
    expect(withMessage(state, mapAt(999.01)).track).toBe(state.track);
  });

  test("of a recording that is opened anew no clip is chosen", () => {
    const before = withMessage(
      { ...initialState(), clipRange: { first: 3, last: 9 } },
      { kind: "findings", frame: 3, runs: [[{ name: "found", value: "yes" }]] },
    );
    expect(before.findings?.runs).toHaveLength(1);
    const anew = withMessage(before, hello);
    expect([anew.clipRange, anew.findings]).toEqual([null, null]);
  });

  test("the team's map is kept until the server begins anew", () => {
    let state = withMessage(initialState(), { kind: "team", objects: [] });
    state = withMessage(state, mapAt(1));
    expect(state.team).toEqual({ kind: "team", objects: [] });
    expect(withMessage(state, hello).team).toBeNull();
  });

  test("tells its listeners of changes until they leave", () => {
    const store = new Store();
    let calls = 0;
    const leave = store.subscribe(() => calls++);
    store.set({ isFrozen: true });
    leave();
    store.set({ isFrozen: false });
    expect(calls).toBe(1);
  });
});

describe("series", () => {
  test("keep the last while, with gaps", () => {
    const buffer = new SeriesBuffer(1, 10);
    for (let i = 0; i <= 100; i++) {
      buffer.add({ kind: "sample", time: `${1_700_000_000 + i}000000000`, values: [i % 2 ? i : null] });
    }
    expect(buffer.newest(0)).toBeNull();
    expect(buffer.newestTime()).toBe(100);
    expect(buffer.columns[0]!.length).toBeLessThanOrEqual(12);
    expect(buffer.columns[1]!.length).toBe(buffer.columns[0]!.length);
  });

  test("begin anew when time goes back", () => {
    const buffer = new SeriesBuffer(1);
    buffer.add({ kind: "sample", time: "9000000000", values: [1] });
    buffer.add({ kind: "sample", time: "2000000000", values: [2] });
    expect(buffer.columns[1]).toEqual([2]);
  });
});

describe("protocol", () => {
  test("times lose nothing", () => {
    expect(secondsBetween("1700000000123456789", "1700000001123457789")).toBe(1.000001);
  });

  test("an image is unpacked", async () => {
    const header = new TextEncoder().encode('{"sequence":7,"shapes":[]}');
    const message = new Uint8Array(4 + header.length + 3);
    new DataView(message.buffer).setUint32(0, header.length, true);
    message.set(header, 4);
    message.set([1, 2, 3], 4 + header.length);
    const image = unpackImage(message.buffer);
    expect(image.header.sequence).toBe(7);
    expect([...new Uint8Array(await image.jpeg.arrayBuffer())]).toEqual([1, 2, 3]);
  });
});
