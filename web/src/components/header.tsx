// SPDX-License-Identifier: BSD-3-Clause
import { nextTheme, pointGimbal, takeSnapshot, toggleHelp, toggleMute, toggleRecording } from "../actions";
import { nextColorStep } from "../color_view";
import { silenceInWords } from "../freshness";
import type { Status } from "../protocol";
import { isFresh, type ConnectionState } from "../store";
import { timeToGo } from "../time_to_go";
import { useClock, useFresh, useStore } from "../use_store";
import { SettingsPanel } from "./settings_panel";

const connectionInWords: Record<ConnectionState, string> = {
  connecting: "Connecting",
  open: "The program or the network is silent",
  lost: "Connection lost, trying again",
  refused: "The token is not known any more: open the link that the program prints",
};

/** Series that a pilot reads: always in view. */
const mainSeries = ["height", "offset", "objects"];

/** State in words, what is wrong, the numbers that a pilot reads, the vehicle, what can be done, and settings. */
export function Header() {
  const isOnTable = useStore((state) => state.page === "study");
  return (
    <header>
      <State />
      {!isOnTable && <MainNumbers />}
      <VehicleFacts />
      <Actions />
      <SettingsPanel />
    </header>
  );
}

interface Said {
  /** Value of data-state in style.css. */
  data: string | undefined;
  words: string;
  reason: string | undefined;
}

function State() {
  const title = useStore((state) => state.hello?.title) ?? "Kestrel";
  const over = useStore((state) => (state.status?.over && state.connection !== "refused" ? state.status : null));
  const said = useSaid();
  const hasSilent = useStore((state) => state.staleness.old.length > 0);
  // The program ends with the flight: what is gone then is no fault. Another may come at its address.
  if (over) return <FlightOver title={title} status={over} />;
  return (
    <div class="state" data-state={said.data} data-alarm={hasSilent}>
      <h1>{title}</h1>
      <p class="state-word" role="status">
        {said.words}
      </p>
      <p class="state-reason">{said.reason}</p>
      <SilentSources />
    </div>
  );
}

/** Returns the words for the state: the vision's only while its images are new. */
function useSaid(): Said {
  useClock(2);
  return useStore((state) => {
    const { connection, hello, status, staleness, freshness, page, colors } = state;
    const now = performance.now();
    if (connection === "refused" || hello === null) return { data: "offline", words: connectionInWords[connection], reason: "" };
    if (staleness.isSilent || (connection !== "open" && hello.live)) {
      return { data: "offline", words: silenceInWords(null, freshness.silence(now)), reason: connectionInWords[connection] };
    }
    if (connection !== "open") return { data: "offline", words: connectionInWords[connection], reason: "" };
    if (staleness.old.includes("frames")) {
      const words = silenceInWords("frames", freshness.age("frames", now));
      return { data: "blind", words, reason: status?.reason };
    }
    if (page === "study") return { data: "table", words: "Study", reason: "" };
    const isKnown = isFresh(state, ["frames"]) || staleness.missing.includes("frames");
    const word = (isKnown && status?.state) || "waiting";
    if (page === "colors" && colors) return { data: word, words: "Teaching colours", reason: nextColorStep(colors) };
    return { data: word.split(", ").at(-1), words: word, reason: isKnown ? status?.reason : "" };
  }, isSameSaid);
}

function isSameSaid(one: Said, other: Said): boolean {
  return one.data === other.data && one.words === other.words && one.reason === other.reason;
}

/** A red line for each source, beside the images, that gives nothing any more. */
function SilentSources() {
  useClock(2);
  const staleness = useStore((state) => state.staleness);
  const freshness = useStore((state) => state.freshness);
  const now = performance.now();
  if (staleness.isSilent) return null;
  return (
    <>
      {staleness.old
        .filter((source) => source !== "frames")
        .map((source) => (
          <p key={source} class="silent" role="alert">
            {silenceInWords(source, freshness.age(source, now))}
          </p>
        ))}
    </>
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
  const isKnown = useFresh(["autopilot"]);
  if (!vehicle) return null;
  return (
    <div class="vehicle" role="group" aria-label="Vehicle" data-stale={!isKnown}>
      <ul>
        {vehicle.facts.map((fact) => (
          <li key={fact.name} data-verdict={isKnown ? fact.verdict : "not checked"}>
            {fact.name} <b>{isKnown ? fact.measured : "–"}</b>
            {isKnown && fact.verdict !== "good" && <span class="unseen"> ({fact.verdict})</span>}
          </li>
        ))}
        {isKnown &&
          vehicle.limits.map(({ limit, share }) => (
            <li key={limit} class="limit" data-verdict={share < 0.95 ? "good" : "doubtful"}>
              {limit} <b>{Math.round(100 * share)} %</b> <meter min={0} max={1} high={0.95} value={share} aria-label={`${limit}, part of the limit`} />
            </li>
          ))}
      </ul>
      {isKnown && vehicle.cannot_follow !== "" && <p role="alert">{vehicle.cannot_follow}</p>}
    </div>
  );
}

function MainNumbers() {
  const series = useStore((state) => state.hello?.series);
  const numbers = (series ?? []).map((one, index) => ({ one, index })).filter(({ one }) => mainSeries.includes(one.name));
  const height = numbers.find(({ one }) => one.name === "height");
  return (
    <dl class="numbers">
      {numbers.map(({ one, index }) => (
        <div key={one.name}>
          <dt>{one.label}</dt>
          <dd>
            <NewestNumber index={index} />
          </dd>
        </div>
      ))}
      {height && (
        <div>
          <dt>Time to go</dt>
          <dd>
            <TimeToGo index={height.index} />
          </dd>
        </div>
      )}
    </dl>
  );
}

/** The newest value of a series; a dash where it is not what is now. */
export function NewestNumber({ index }: { index: number }) {
  useClock(5);
  const one = useStore((state) => state.hello?.series[index]);
  const buffer = useStore((state) => state.series);
  const isKnown = useFresh(one?.sources ?? []);
  return (
    <>
      {numberText(isKnown ? buffer.newest(index) : null, one?.is_count ?? false)} <small>{one?.unit}</small>
    </>
  );
}

function TimeToGo({ index }: { index: number }) {
  useClock(5);
  const live = useStore((state) => state.series);
  const flight = useStore((state) => state.flight);
  const frame = useStore((state) => state.playback?.frame);
  const isKnown = useFresh(useStore((state) => state.hello?.series[index]?.sources) ?? []);
  const { columns } = flight ?? live;
  const seconds = isKnown ? timeToGo(columns[0]!, columns[index + 1]!, flight ? frame : undefined) : null;
  return (
    <>
      {seconds === null ? "–" : seconds.toFixed(0)} <small>s</small>
    </>
  );
}

export function numberText(value: number | null, isCount: boolean): string {
  if (value === null) return "–";
  if (isCount) return value.toFixed(0);
  return value.toFixed(Math.abs(value) < 10 ? 2 : Math.abs(value) < 100 ? 1 : 0);
}

function Actions() {
  const offers = useStore((state) => (state.status?.over ? undefined : state.hello?.offers));
  const canAlarm = useStore((state) => (state.hello?.live ?? false) && !state.status?.over);
  const isRecording = useStore((state) => state.status?.recording ?? false);
  const isMuted = useStore((state) => state.isMuted);
  const theme = useStore((state) => state.theme);
  return (
    <div class="actions">
      {offers?.includes("record") && (
        <button class="record" aria-pressed={isRecording} onClick={toggleRecording}>
          {isRecording ? "■ Stop recording" : "● Record"}
        </button>
      )}
      {offers?.includes("snapshot") && <button onClick={takeSnapshot}>Snapshot</button>}
      {offers?.includes("point") && <button onClick={pointGimbal}>Point gimbal</button>}
      {canAlarm && (
        <button aria-pressed={isMuted} onClick={toggleMute}>
          Mute
        </button>
      )}
      <button onClick={nextTheme}>Theme: {theme}</button>
      <button onClick={toggleHelp}>Keys</button>
    </div>
  );
}
