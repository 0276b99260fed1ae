// SPDX-License-Identifier: BSD-3-Clause
import { useEffect, useRef } from "preact/hooks";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Series } from "../protocol";
import type { SeriesBuffer } from "../series_buffer";
import { store } from "../store";
import { themeColor } from "../theme";
import { useStore } from "../use_store";
import { NewestNumber, numberText } from "./header";

const drawsPerSecond = 5;
const chartHeight = 110;

/** Each series, of a flight the last minute, of a recording all; the time under the pointer is the same in all. */
export function Charts() {
  const hello = useStore((state) => state.hello);
  const live = useStore((state) => state.series);
  const flight = useStore((state) => state.flight);
  const theme = useStore((state) => state.theme);
  return (
    <section class="charts" aria-label="Time series">
      <h2>{flight ? "The whole recording" : "The last minute"}</h2>
      <div class="chart-grid">
        {hello?.series.map((one, i) => (
          <Chart key={`${one.name} ${theme}`} series={one} buffer={flight ?? live} isRecording={flight !== null} index={i} />
        ))}
      </div>
    </section>
  );
}

interface ChartProps {
  series: Series;
  buffer: SeriesBuffer;
  isRecording: boolean;
  index: number;
}

function Chart({ series, buffer, isRecording, index }: ChartProps) {
  const place = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (!place.current) return undefined;
    const plot = new uPlot(plotOptions(series, place.current.clientWidth), [[], []], place.current);
    const draw = () => plot.setData([buffer.columns[0]!, buffer.columns[index + 1]!] as uPlot.AlignedData);
    const resize = new ResizeObserver(() => {
      if (place.current) plot.setSize({ width: place.current.clientWidth, height: chartHeight });
    });
    resize.observe(place.current);
    draw();
    // The samples of a recording do not change, but the frame that is shown does.
    const timer = setInterval(isRecording ? () => plot.redraw(false) : draw, 1000 / drawsPerSecond);
    return () => {
      clearInterval(timer);
      resize.disconnect();
      plot.destroy();
    };
  }, [buffer, isRecording, index]);
  const title = series.unit === "" ? series.label : `${series.label}, ${series.unit}`;
  return (
    <figure>
      <figcaption>
        {series.label} <b><NewestNumber index={index} /></b>
      </figcaption>
      <div ref={place} class="plot" role="img" aria-label={`${title}, ${isRecording ? "the whole recording" : "the last minute"}`} />
    </figure>
  );
}

// The time of the frame that is shown.
function drawPlayhead(plot: uPlot): void {
  const { flight, playback } = store.state;
  const time = flight?.columns[0]?.[playback?.frame ?? -1];
  if (time === null || time === undefined) return;
  const x = plot.valToPos(time, "x", true);
  plot.ctx.fillStyle = themeColor("wrong");
  plot.ctx.fillRect(x - 1, plot.bbox.top, 2, plot.bbox.height);
}

function plotOptions(series: Series, width: number): uPlot.Options {
  const axis = {
    stroke: themeColor("text"),
    grid: { stroke: themeColor("grid"), width: 1 },
    ticks: { show: false },
    font: "12px system-ui, sans-serif",
  };
  return {
    width,
    height: chartHeight,
    padding: [6, 8, 0, 0],
    legend: { show: false },
    cursor: { sync: { key: "console" }, drag: { x: false, y: false } },
    scales: { x: { time: false } },
    axes: [
      { ...axis, size: 22, values: (_, ticks) => ticks.map((tick) => `${tick} s`) },
      { ...axis, size: 48, values: (_, ticks) => ticks.map((tick) => numberText(tick, series.is_count)) },
    ],
    hooks: { draw: [drawPlayhead] },
    series: [{}, { label: series.label, stroke: themeColor("line"), width: 2, spanGaps: false }],
  };
}
