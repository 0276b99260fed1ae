// SPDX-License-Identifier: BSD-3-Clause
import { nextTheme, takeSnapshot, toggleHelp, toggleRecording } from "../actions";
import { nextColorStep } from "../color_view";
import type { Status } from "../protocol";
import type { ConnectionState } from "../store";
import { useClock, useStore } from "../use_store";

const connectionInWords: Record<ConnectionState, string> = {
  connecting: "Connecting",
  open: "Connected",
  lost: "Connection lost, trying again",
  refused: "The token is not known any more: open the link that the program prints",
};

/** State in words (the last of them is what the vision says), the vehicle, the newest number of each series, and what can be done. */
export function Header() {
  const isOnTable = useStore((state) => state.page === "study");
  return (
    <header>
      <State />
      <VehicleFacts />
      {!isOnTable && <Numbers />}
      <Actions />
    </header>
  );
}

function State() {
  const connection = useStore((state) => state.connection);
  const title = useStore((state) => state.hello?.title);
  const status = useStore((state) => state.status);
  const teaching = useStore((state) => (state.page === "colors" ? state.colors : null));
  const isOnTable = useStore((state) => state.page === "study");
  const isOpen = connection === "open";
  // The program ends with the flight: what is gone then is no fault. Another may come at its address.
  if (status?.over && connection !== "refused") return <FlightOver title={title ?? "Kestrel"} status={status} />;
  const words = isOnTable ? "Study" : teaching ? "Teaching colours" : (status?.state ?? "waiting");
  return (
    <div class="state" data-state={isOpen ? isOnTable ? "table" : status?.state.split(", ").at(-1) : "offline"}>
      <h1>{title ?? "Kestrel"}</h1>
      <p class="state-word" role="status">
        {isOpen ? words : connectionInWords[connection]}
      </p>
      <p class="state-reason">{!isOpen || isOnTable ? "" : teaching ? nextColorStep(teaching) : status?.reason}</p>
    </div>
  );
}

function FlightOver({ title, status }: { title: string; status: Status }) {
  return (
    <div class="state" data-state="over">
      <h1>{title}</h1>
      <p class="state-word" role="status">
        Flight over: {status.reason}
      </p>
      <p class="state-reason">
        {status.replay === "" ? (
          "It was not recorded: fly with --record to see it again"
        ) : (
          <>
            See it again: <code>kestrel console {status.replay}</code>, then <a href="/">open its replay</a>
          </>
        )}
      </p>
    </div>
  );
}

/** Mode, battery and so on as the autopilot reports them, and how much of the limits guidance uses. */
function VehicleFacts() {
  const vehicle = useStore((state) => state.vehicle);
  if (!vehicle) return null;
  return (
    <div class="vehicle" role="group" aria-label="Vehicle">
      <ul>
        {vehicle.facts.map((fact) => (
          <li key={fact.name} data-verdict={fact.verdict}>
            {fact.name} <b>{fact.measured}</b>
            {fact.verdict !== "good" && <span class="unseen"> ({fact.verdict})</span>}
          </li>
        ))}
        {vehicle.limits.map(({ limit, share }) => (
          <li key={limit} data-verdict={share < 0.95 ? "good" : "doubtful"}>
            {limit} <b>{Math.round(100 * share)} %</b> <meter min={0} max={1} high={0.95} value={share} aria-label={`${limit}, part of the limit`} />
          </li>
        ))}
      </ul>
      {vehicle.cannot_follow !== "" && <p role="alert">{vehicle.cannot_follow}</p>}
    </div>
  );
}

function Numbers() {
  useClock(5);
  const hello = useStore((state) => state.hello);
  const series = useStore((state) => state.series);
  return (
    <dl class="numbers">
      {hello?.series.map((one, i) => (
        <div key={one.name}>
          <dt>{one.label}</dt>
          <dd>
            {numberText(series.newest(i), one.is_count)} <small>{one.unit}</small>
          </dd>
        </div>
      ))}
    </dl>
  );
}

export function numberText(value: number | null, isCount: boolean): string {
  if (value === null) return "–";
  if (isCount) return value.toFixed(0);
  return value.toFixed(Math.abs(value) < 10 ? 2 : Math.abs(value) < 100 ? 1 : 0);
}

function Actions() {
  const offers = useStore((state) => (state.status?.over ? undefined : state.hello?.offers));
  const isRecording = useStore((state) => state.status?.recording ?? false);
  const theme = useStore((state) => state.theme);
  return (
    <div class="actions">
      {offers?.includes("record") && (
        <button class="record" aria-pressed={isRecording} onClick={toggleRecording}>
          {isRecording ? "■ Stop recording" : "● Record"}
        </button>
      )}
      {offers?.includes("snapshot") && <button onClick={takeSnapshot}>Snapshot</button>}
      <button onClick={nextTheme}>Theme: {theme}</button>
      <button onClick={toggleHelp}>Keys</button>
    </div>
  );
}
