// SPDX-License-Identifier: BSD-3-Clause
import { useState } from "preact/hooks";
import {
  boardNames,
  boards,
  counted,
  focalText,
  goalsOf,
  usualForms,
  type Board,
  type BoardForm,
  type Lens,
} from "../lens";
import { beginLens, saveLens, stopLens } from "../lens_actions";
import { useClock, useStore } from "../use_store";
import "./camera_page.css";
import { EventsPanel } from "./events_panel";
import { numberText } from "./header";
import { ImageView } from "./image_view";

/** A camera of which nothing is known: its picture, what it is like, and the calibration of its lens. */
export function CameraPage() {
  const lens = useStore((state) => state.lens);
  return (
    <main class="camera">
      <div class="column">
        {lens?.running && <Advice lens={lens} />}
        <ImageView />
        <Picture />
      </div>
      <div class="column">
        {lens && <LensSection lens={lens} />}
        <EventsPanel />
      </div>
    </main>
  );
}

/** Rate, exposure and focus in numbers. */
function Picture() {
  useClock(2);
  const series = useStore((state) => state.series);
  const described = useStore((state) => state.hello?.series ?? []);
  return (
    <section aria-label="Picture">
      <dl class="camera-numbers">
        {described.map((one, i) => (
          <div key={one.name}>
            <dt>{one.label}</dt>
            <dd>
              {numberText(series.newest(i), one.is_count)} <small>{one.unit}</small>
            </dd>
          </div>
        ))}
      </dl>
      <p class="hint">Turn the lens until the sharpness no longer rises. Less than 1 % should be clipped.</p>
    </section>
  );
}

function Advice({ lens }: { lens: Lens }) {
  return (
    <p class="lens-advice" role="status" data-good={lens.good}>
      {lens.advice}
    </p>
  );
}

function LensSection({ lens }: { lens: Lens }) {
  return (
    <section class="lens" aria-label="Calibrate the lens">
      <h2>Calibrate the lens</h2>
      {lens.running ? <Running lens={lens} /> : <Form lens={lens} />}
      {lens.estimate && <Estimate lens={lens} />}
      {lens.estimate && <Save lens={lens} />}
    </section>
  );
}

function Form({ lens }: { lens: Lens }) {
  const [form, setForm] = useState<BoardForm>(usualForms.chessboard);
  const [model, setModel] = useState("");
  const begin = (event: Event) => {
    event.preventDefault();
    beginLens(form, model);
  };
  return (
    <form onSubmit={begin}>
      <label>
        Board
        <select value={form.board} onChange={(event) => setForm(usualForms[event.currentTarget.value as Board])}>
          {boards.map((board) => (
            <option key={board} value={board}>
              {boardNames[board]}
            </option>
          ))}
        </select>
      </label>
      {form.board !== "print" && <Size form={form} setForm={setForm} />}
      <label>
        Lens
        <select value={model} onChange={(event) => setModel(event.currentTarget.value)}>
          <option value="">what fits best</option>
          <option value="radial-tangential">usual lens (radial-tangential)</option>
          <option value="equidistant">fisheye (equidistant)</option>
        </select>
      </label>
      <button type="submit">Begin</button>
      {lens.error !== "" && <p role="alert">{lens.error}</p>}
    </form>
  );
}

function Size({ form, setForm }: { form: BoardForm; setForm: (form: BoardForm) => void }) {
  const isTags = form.board === "aprilgrid";
  const number = (label: string, key: "columns" | "rows" | "side_mm" | "marker_mm" | "gap", step: string) => (
    <label>
      {label}
      <input
        type="number"
        min="0"
        step={step}
        required
        value={form[key]}
        onInput={(event) => setForm({ ...form, [key]: event.currentTarget.valueAsNumber })}
      />
    </label>
  );
  return (
    <>
      {number(`Columns (${counted[form.board]})`, "columns", "1")}
      {number(`Rows (${counted[form.board]})`, "rows", "1")}
      {number(isTags ? "Side of a tag, mm" : "Side of a square, mm", "side_mm", "any")}
      {form.board === "charuco" && number("Side of a marker, mm", "marker_mm", "any")}
      {form.board === "charuco" && (
        <label>
          Dictionary
          <input value={form.family} onInput={(event) => setForm({ ...form, family: event.currentTarget.value })} />
        </label>
      )}
      {isTags && number("Gap over side", "gap", "any")}
    </>
  );
}

function Running({ lens }: { lens: Lens }) {
  return (
    <>
      <p>
        {boardName(lens)}: <b>{lens.views}</b> views
      </p>
      <CoverageMap lens={lens} />
      <ul class="lens-goals" aria-label="Tilts and distances">
        {goalsOf(lens).map(({ name, views, wanted }) => (
          <li key={name} data-done={views >= wanted}>
            {views >= wanted ? "✓" : "○"} {name}: {views} of {wanted}
          </li>
        ))}
      </ul>
      {lens.refusal !== "" && <p class="hint">{lens.refusal}</p>}
      <button onClick={stopLens}>Stop</button>
    </>
  );
}

function boardName(lens: Lens): string {
  return lens.board === "" ? boardNames.print : lens.board;
}

/** The fields of the image: those that a board has been in are filled. */
function CoverageMap({ lens }: { lens: Lens }) {
  const covered = lens.fields.filter((corners) => corners > 0).length;
  return (
    <div
      class="coverage-map"
      role="img"
      aria-label={`The board was in ${covered} of ${lens.fields.length} fields of the image`}
      style={{ gridTemplateColumns: `repeat(${lens.columns}, 1fr)` }}
    >
      {lens.fields.map((corners, i) => (
        <span key={i} data-covered={corners > 0} />
      ))}
    </div>
  );
}

function Estimate({ lens }: { lens: Lens }) {
  const { estimate } = lens;
  if (!estimate) return null;
  return (
    <>
      <dl class="camera-numbers">
        <div>
          <dt>Focal length</dt>
          <dd>{focalText(estimate)}</dd>
        </div>
        <div>
          <dt>Residual (RMS)</dt>
          <dd>{estimate.rms_px.toFixed(2)} px</dd>
        </div>
        <div>
          <dt>Lens, views</dt>
          <dd>
            {estimate.model}, {estimate.views}
          </dd>
        </div>
      </dl>
      {estimate.warnings.map((warning) => (
        <p key={warning} class="warning">
          {warning}
        </p>
      ))}
      {lens.good && <p class="lens-good">Good enough: save it.</p>}
    </>
  );
}

function Save({ lens }: { lens: Lens }) {
  const [name, setName] = useState("camera.yaml");
  const save = (event: Event) => {
    event.preventDefault();
    saveLens(name, false);
  };
  return (
    <form onSubmit={save}>
      <label>
        File in {lens.folder}
        <input value={name} required onInput={(event) => setName(event.currentTarget.value)} />
      </label>
      <button type="submit">Save</button>
      {lens.exists && (
        <p role="alert">
          {name} exists already.{" "}
          <button type="button" onClick={() => saveLens(name, true)}>
            Replace it
          </button>
        </p>
      )}
      {lens.save_error !== "" && <p role="alert">Not saved: {lens.save_error}</p>}
      {lens.saved !== "" && (
        <p role="status">
          Saved as {lens.saved}. Next: <code>{lens.next}</code>
        </p>
      )}
    </form>
  );
}
