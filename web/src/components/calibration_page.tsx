// SPDX-License-Identifier: BSD-3-Clause
import { useState } from "preact/hooks";
import {
  advice,
  progressInWords,
  sigmaText,
  subjectInWords,
  subjects,
  valueText,
  type Calibration,
  type Subject,
} from "../calibration";
import { calibrate, cancelCalibration, saveCalibration } from "../calibration_actions";
import { useStore } from "../use_store";
import "./calibration_page.css";
import { CoveragePlot, DistancePlot, ResidualPlot } from "./calibration_plots";

/** Mount, clock and lens from the recording: what it covers, what is left, the numbers, save. */
export function CalibrationPage() {
  const calibration = useStore((state) => state.calibration);
  return (
    <main class="calibration">
      <div class="column">
        <Form isRunning={calibration?.state === "running"} />
        {calibration && <Outcome calibration={calibration} />}
      </div>
      <div class="column">
        {calibration && calibration.coverage !== "" && <Coverage calibration={calibration} />}
        {calibration?.state === "done" && <ResidualsSection calibration={calibration} />}
      </div>
    </main>
  );
}

function Form({ isRunning }: { isRunning: boolean }) {
  const [subject, setSubject] = useState<Subject>("mount and clock");
  const [isMoving, setMoving] = useState(false);
  const run = (event: Event) => {
    event.preventDefault();
    calibrate(subject, isMoving);
  };
  return (
    <section aria-label="Calibrate">
      <h2>Calibrate from this recording</h2>
      <form onSubmit={run}>
        <fieldset>
          <legend>What</legend>
          {subjects.map((one) => (
            <label key={one}>
              <input
                type="radio"
                name="subject"
                checked={subject === one}
                onChange={() => setSubject(one)}
              />
              {one}
            </label>
          ))}
        </fieldset>
        <p class="hint">{advice[subject]}</p>
        {subject !== "lens" && (
          <label>
            <input
              type="checkbox"
              checked={isMoving}
              onChange={(event) => setMoving(event.currentTarget.checked)}
            />
            the pattern moves, on a smooth path
          </label>
        )}
        <div class="replay-buttons">
          <button type="submit" disabled={isRunning}>
            Calibrate
          </button>
          {isRunning && (
            <button type="button" onClick={cancelCalibration}>
              Cancel
            </button>
          )}
        </div>
      </form>
    </section>
  );
}

function Outcome({ calibration }: { calibration: Calibration }) {
  const subject = subjectInWords(calibration.asked);
  switch (calibration.state) {
    case "none":
      return null;
    case "running":
      return (
        <section aria-label="Progress">
          <h2>{subject}</h2>
          <p role="status">{progressInWords(calibration)}</p>
          <progress aria-label="Images looked at" max={calibration.of} value={calibration.done} />
        </section>
      );
    case "cancelled":
      return (
        <section aria-label="Progress">
          <p role="status">Cancelled: {subject}</p>
        </section>
      );
    case "refused":
      return (
        <section aria-label="Refusal">
          <h2>Refused: {subject}</h2>
          <p role="alert">{calibration.error}</p>
        </section>
      );
    case "done":
      return <Result calibration={calibration} subject={subject} />;
  }
}

function Result({ calibration, subject }: { calibration: Calibration; subject: string }) {
  return (
    <section aria-label="Result">
      <h2>Result: {subject}</h2>
      <table class="numbers-table">
        <thead>
          <tr>
            <th scope="col">Quantity</th>
            <th scope="col">Before</th>
            <th scope="col">After</th>
            <th scope="col">Standard deviation</th>
          </tr>
        </thead>
        <tbody>
          {calibration.numbers.map(({ name, unit, before, after, sigma }) => (
            <tr key={name}>
              <th scope="row">
                {name}
                {unit !== "" && <small> {unit}</small>}
              </th>
              <td>{valueText(before, sigma)}</td>
              <td>{valueText(after, sigma)}</td>
              <td>{sigmaText(sigma)}</td>
            </tr>
          ))}
        </tbody>
      </table>
      {calibration.warnings.map((warning) => (
        <p key={warning} class="warning">
          <b>Warning:</b> {warning}
        </p>
      ))}
      <Save calibration={calibration} />
    </section>
  );
}

function Save({ calibration }: { calibration: Calibration }) {
  const { number, can_save, no_use, saved, save_error } = calibration;
  if (no_use !== "") return <p class="hint">Nothing to save: {no_use}.</p>;
  return (
    <>
      <div class="replay-buttons">
        {can_save && <button onClick={saveCalibration}>Save</button>}
        <a class="download" href={`/export/calibration-${number}.yaml`} download>
          Download (YAML, for --camera)
        </a>
      </div>
      {!can_save && <p class="hint">With --output FOLDER the program can save it where it runs.</p>}
      {saved !== "" && <p role="status">Saved as {saved}</p>}
      {save_error !== "" && <p role="alert">Not saved: {save_error}</p>}
    </>
  );
}

function Coverage({ calibration }: { calibration: Calibration }) {
  return (
    <section aria-label="Coverage">
      <h2>Coverage</h2>
      <p>{calibration.coverage}</p>
      <CoveragePlot calibration={calibration} />
      <DistancePlot calibration={calibration} />
    </section>
  );
}

function ResidualsSection({ calibration }: { calibration: Calibration }) {
  const { of, unit, rms_before, rms_after } = calibration.residuals;
  const text = (rms: number | null) => (rms === null ? "not known" : `${rms.toPrecision(3)} ${unit}`);
  return (
    <section aria-label="Residuals">
      <h2>What is left: {of}</h2>
      <p>
        Root mean square before: <b>{text(rms_before)}</b>, after: <b>{text(rms_after)}</b>
      </p>
      <ResidualPlot residuals={calibration.residuals} />
    </section>
  );
}
