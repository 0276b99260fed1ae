// SPDX-License-Identifier: BSD-3-Clause
import { barsOf, decadesAround, type Calibration, type Residuals } from "../calibration";

/** Fields of the image, as the server counts them. */
const columns = 8;
const rows = 6;

/** A mark at each point: a line of no length with round ends. */
function dots(points: [number, number][]): string {
  return points.map(([x, y]) => `M${x.toFixed(1)} ${y.toFixed(1)}h0`).join("");
}

function pairs(numbers: number[]): [number, number][] {
  return Array.from({ length: numbers.length / 2 }, (_, i) => [numbers[2 * i]!, numbers[2 * i + 1]!]);
}

/** Where in the image the pattern was, over the fields by which coverage is counted. */
export function CoveragePlot({ calibration }: { calibration: Calibration }) {
  const { width, height, places } = calibration;
  const lines = [
    ...Array.from({ length: columns - 1 }, (_, i) => `M${((i + 1) * width) / columns} 0v${height}`),
    ...Array.from({ length: rows - 1 }, (_, i) => `M0 ${((i + 1) * height) / rows}h${width}`),
  ];
  return (
    <figure>
      <figcaption>Where in the image</figcaption>
      <svg viewBox={`0 0 ${width} ${height}`} role="img" aria-label={calibration.coverage}>
        <rect class="frame" width={width} height={height} />
        <path class="grid" d={lines.join("")} stroke-width={width / 800} />
        <path class="places" d={dots(pairs(places))} stroke-width={width / 130} />
      </svg>
    </figure>
  );
}

const barWidth = 40;
const barHeight = 110;

/** How often the camera was at which distance from the pattern. */
export function DistancePlot({ calibration }: { calibration: Calibration }) {
  const bars = barsOf(calibration.distances_m, 10);
  const most = Math.max(...bars.map(({ count }) => count), 1);
  const inWords = bars.map((bar) => `${bar.from.toFixed(1)} to ${bar.to.toFixed(1)} m: ${bar.count}`);
  if (bars.length === 0) return null;
  return (
    <figure>
      <figcaption>{calibration.distance_name}, m</figcaption>
      <svg
        viewBox={`0 0 ${bars.length * barWidth + 20} ${barHeight + 40}`}
        role="img"
        aria-label={`${calibration.distance_name}: ${inWords.join(", ")}`}
      >
        {bars.map((bar, i) => {
          const height = (bar.count / most) * barHeight;
          const x = 10 + i * barWidth;
          return (
            <g key={i}>
              <rect class="bar" x={x + 2} y={barHeight + 16 - height} width={barWidth - 4} height={height} />
              <text x={x + barWidth / 2} y={barHeight + 12 - height}>
                {bar.count === 0 ? "" : bar.count}
              </text>
              <text x={x} y={barHeight + 34}>
                {bar.from.toFixed(1)}
              </text>
            </g>
          );
        })}
        <text x={10 + bars.length * barWidth} y={barHeight + 34}>
          {bars.at(-1)!.to.toFixed(1)}
        </text>
      </svg>
    </figure>
  );
}

const plot = { width: 640, height: 260, left: 60, right: 10, top: 10, bottom: 40 };

/** Each residual before (open) and after (filled), on a logarithmic scale. */
export function ResidualPlot({ residuals }: { residuals: Residuals }) {
  const values = residuals.points.flatMap(([, before, after]) => [before ?? 0, after ?? 0]);
  const [low, high] = decadesAround(values);
  const overs = residuals.points.map(([over]) => over ?? 0);
  const first = Math.min(...overs, 0);
  const last = Math.max(...overs, first + 1e-9);
  const x = (over: number) =>
    plot.left + ((over - first) / (last - first)) * (plot.width - plot.left - plot.right);
  const y = (value: number) => {
    const share = (Math.log10(Math.max(value, 10 ** low)) - low) / (high - low);
    return plot.height - plot.bottom - share * (plot.height - plot.top - plot.bottom);
  };
  const series = (index: 1 | 2) =>
    residuals.points.flatMap((point): [number, number][] => {
      const [over, value] = [point[0], point[index]];
      return typeof over === "number" && typeof value === "number" ? [[x(over), y(value)]] : [];
    });
  const decades = Array.from({ length: high - low + 1 }, (_, i) => low + i);
  return (
    <figure>
      <figcaption class="residual-legend">
        <svg viewBox="0 0 16 16" aria-hidden="true">
          <path class="before" d="M8 8h0" stroke-width="8" />
          <path class="before-inside" d="M8 8h0" stroke-width="4" />
        </svg>
        before{" "}
        <svg viewBox="0 0 16 16" aria-hidden="true">
          <path class="after" d="M8 8h0" stroke-width="7" />
        </svg>
        after, {residuals.unit}, over {residuals.over}
      </figcaption>
      <svg
        viewBox={`0 0 ${plot.width} ${plot.height}`}
        role="img"
        aria-label={`${residuals.of} before and after, over ${residuals.over}`}
      >
        {decades.map((decade) => (
          <g key={decade}>
            <path class="grid" d={`M${plot.left} ${y(10 ** decade)}H${plot.width - plot.right}`} />
            <text class="end" x={plot.left - 6} y={y(10 ** decade) + 4}>
              {decade < 0 ? (10 ** decade).toFixed(-decade) : 10 ** decade}
            </text>
          </g>
        ))}
        {[0, 0.25, 0.5, 0.75, 1].map((share) => (
          <text key={share} x={x(first + share * (last - first))} y={plot.height - 16}>
            {(first + share * (last - first)).toFixed(last - first < 100 ? 1 : 0)}
          </text>
        ))}
        <path class="before" d={dots(series(1))} stroke-width="5" />
        <path class="before-inside" d={dots(series(1))} stroke-width="2.5" />
        <path class="after" d={dots(series(2))} stroke-width="4" />
      </svg>
    </figure>
  );
}
