// SPDX-License-Identifier: BSD-3-Clause
import { useEffect, useRef } from "preact/hooks";
import { toggleTeam } from "../actions";
import {
  covarianceEllipse,
  fitView,
  pointsOf,
  scaleLength,
  teamLabel,
  toCanvas,
  type MapView,
} from "../map_geometry";
import type { MapMessage, MapObject, TeamObject } from "../protocol";
import { isFresh } from "../store";
import { themeColor } from "../theme";
import { useStore } from "../use_store";

const sigmas = 2;
const noObjects: TeamObject[] = [];

/**
 * Seen from above, north up: UAV and its way, target, prediction, objects, each with 2 sigma; dashed
 * squares are what the team knows of.
 */
export function MapPanel() {
  const canvas = useRef<HTMLCanvasElement>(null);
  const map = useStore((state) => (isFresh(state, ["frames", "pose"]) ? state.map : null));
  const track = useStore((state) => state.track);
  const hasTeam = useStore((state) => state.team !== null);
  const team = useStore((state) => (state.isTeamShown && state.team?.objects) || noObjects);
  const theme = useStore((state) => state.theme);
  const draw = useRef(() => {});
  draw.current = () => {
    if (canvas.current) drawMap(canvas.current, map, team, track);
  };
  useEffect(() => draw.current(), [map, team, track, theme]);
  useEffect(() => {
    const resize = new ResizeObserver(() => draw.current());
    if (canvas.current) resize.observe(canvas.current);
    return () => resize.disconnect();
  }, []);
  return (
    <section class="map" aria-label="Map">
      <h2>Map</h2>
      <canvas ref={canvas} role="img" aria-label={mapInWords(map, team)} />
      <p class="legend">
        <span data-of="uav">UAV</span> <span data-of="target">target</span>{" "}
        <span data-of="prediction">prediction</span> (ellipses: 2 sigma; squares: in the hunt's map)
      </p>
      {hasTeam && <TeamSwitch />}
    </section>
  );
}

function TeamSwitch() {
  const isShown = useStore((state) => state.isTeamShown);
  return (
    <div class="switches" role="group" aria-label="Map">
      <button aria-pressed={isShown} onClick={toggleTeam}>
        <span class="swatch" data-of="team" />
        team
      </button>
    </div>
  );
}

function mapInWords(map: MapMessage | null, team: TeamObject[]): string {
  const ofTeam = team.length > 0 ? `, ${team.length} objects of the team` : "";
  if (!map?.uav) return ofTeam ? `map${ofTeam}` : "map, nothing known now";
  const known = (map.mapped.length > 0 ? `, ${map.mapped.length} objects in the map` : "") + ofTeam;
  if (map.objects.length > 0) return `map with the UAV, ${map.objects.length} objects in view${known}`;
  if (!map.target) return `map with the UAV, no target${known}`;
  const distance = Math.hypot(
    map.target.position[0] - map.uav[0],
    map.target.position[1] - map.uav[1],
  );
  return `map, target ${distance.toFixed(1)} m from the UAV`;
}

function drawMap(
  canvas: HTMLCanvasElement,
  map: MapMessage | null,
  team: TeamObject[],
  track: [number, number][],
): void {
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const context = canvas.getContext("2d");
  if (!context) return;
  context.scale(ratio, ratio);
  const view = fitView(pointsOf(map, team, track, sigmas), width, height);
  drawGrid(context, view);
  drawLine(context, view, track, themeColor("muted"));
  for (const object of team) drawTeamObject(context, view, object);
  if (!map) return;
  for (const object of map.mapped) drawMapped(context, view, object);
  for (const object of map.objects) drawObject(context, view, object, object.color || "gray");
  const color = themeColor("prediction");
  const ahead = map.prediction.map((object) => object.position);
  drawLine(context, view, map.target ? [map.target.position, ...ahead] : ahead, color);
  for (const object of map.prediction) drawObject(context, view, object, color);
  if (map.target) drawObject(context, view, map.target, themeColor("target"));
  if (map.uav) drawUav(context, view, map.uav, map.heading);
}

function drawGrid(context: CanvasRenderingContext2D, view: MapView): void {
  const meters = scaleLength(view.pixelsPerMeter, view.width / 4);
  const step = meters * view.pixelsPerMeter;
  const [x0, y0] = toCanvas(view, [0, 0]);
  context.strokeStyle = themeColor("grid");
  context.lineWidth = 1;
  context.beginPath();
  for (let x = x0 - Math.floor(x0 / step) * step; x < view.width; x += step) {
    context.moveTo(x, 0);
    context.lineTo(x, view.height);
  }
  for (let y = y0 - Math.floor(y0 / step) * step; y < view.height; y += step) {
    context.moveTo(0, y);
    context.lineTo(view.width, y);
  }
  context.stroke();
  context.fillStyle = themeColor("text");
  context.font = "12px system-ui, sans-serif";
  context.fillText(`grid ${meters} m, north up`, 8, view.height - 8);
}

function drawLine(
  context: CanvasRenderingContext2D,
  view: MapView,
  points: [number, number][],
  color: string,
): void {
  context.strokeStyle = color;
  context.lineWidth = 2;
  context.beginPath();
  for (const point of points) context.lineTo(...toCanvas(view, point));
  context.stroke();
}

function drawObject(
  context: CanvasRenderingContext2D,
  view: MapView,
  object: MapObject,
  color: string,
): void {
  const [x, y] = toCanvas(view, object.position);
  const ellipse = covarianceEllipse(object.covariance, sigmas);
  context.strokeStyle = color;
  context.fillStyle = color;
  context.lineWidth = 2;
  context.beginPath();
  context.ellipse(
    x,
    y,
    Math.max(ellipse.major * view.pixelsPerMeter, 2),
    Math.max(ellipse.minor * view.pixelsPerMeter, 2),
    -ellipse.angle,
    0,
    2 * Math.PI,
  );
  context.globalAlpha = 0.2;
  context.fill();
  context.globalAlpha = 1;
  context.stroke();
  context.fillRect(x - 2, y - 2, 4, 4);
  context.fillStyle = themeColor("text");
  context.font = "12px system-ui, sans-serif";
  context.fillText(object.label, x + 8, y - 6);
}

// A hollow square, and its name below: that of the same object in view is above.
function drawMapped(context: CanvasRenderingContext2D, view: MapView, object: MapObject): void {
  const [x, y] = toCanvas(view, object.position);
  context.strokeStyle = themeColor("text");
  context.lineWidth = 1.5;
  context.strokeRect(x - 5, y - 5, 10, 10);
  context.fillStyle = themeColor("text");
  context.font = "12px system-ui, sans-serif";
  context.fillText(object.label, x + 8, y + 14);
}

// A dashed square; filled where somebody goes for it.
function drawTeamObject(
  context: CanvasRenderingContext2D,
  view: MapView,
  object: TeamObject,
): void {
  const half = 6;
  const [x, y] = toCanvas(view, object.position);
  context.strokeStyle = context.fillStyle = themeColor("team");
  context.lineWidth = 2;
  context.setLineDash([3, 2]);
  context.strokeRect(x - half, y - half, 2 * half, 2 * half);
  context.setLineDash([]);
  if (object.holder) context.fillRect(x - half / 2, y - half / 2, half, half);
  context.fillStyle = themeColor("text");
  context.font = "12px system-ui, sans-serif";
  // Towards the middle: the names of a team are long.
  const isRight = x > view.width / 2;
  context.textAlign = isRight ? "right" : "left";
  context.fillText(teamLabel(object), x + (isRight ? -1 : 1) * (half + 3), y + half + 6);
  context.textAlign = "left";
}

function drawUav(
  context: CanvasRenderingContext2D,
  view: MapView,
  position: [number, number],
  heading: number,
): void {
  context.save();
  context.translate(...toCanvas(view, position));
  context.rotate(-heading);
  context.fillStyle = themeColor("uav");
  context.beginPath();
  context.moveTo(11, 0);
  context.lineTo(-8, 7);
  context.lineTo(-4, 0);
  context.lineTo(-8, -7);
  context.fill();
  context.restore();
}
