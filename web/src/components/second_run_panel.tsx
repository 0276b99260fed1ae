// SPDX-License-Identifier: BSD-3-Clause
import { useState } from "preact/hooks";
import { cancelDetection, detectAgain, seekDifference, toggleBeside } from "../actions";
import type { Option, SecondRun } from "../protocol";
import { marksInWords } from "../timeline";
import { useStore } from "../use_store";

/** Runs the detector over the recording once more with other options, and compares. */
export function SecondRunPanel() {
  const options = useStore((state) => state.options);
  const second = useStore((state) => state.second);
  const [values, setValues] = useState<Record<string, string>>({});
  const changed = options.filter(({ name }) => values[name] !== undefined);
  const others = options.filter(({ name }) => values[name] === undefined);
  const change = (name: string, value: string) => setValues({ ...values, [name]: value });
  const remove = (name: string) =>
    setValues(Object.fromEntries(Object.entries(values).filter(([key]) => key !== name)));
  const isRunning = second?.state === "running";
  const run = (event: Event) => {
    event.preventDefault();
    detectAgain(changed.map(({ name }) => `${name}=${values[name]}`));
  };
  return (
    <section class="second-run" aria-label="Second run">
      <h2>Detect again</h2>
      <form onSubmit={run}>
        {changed.map((option) => (
          <OptionInput
            key={option.name}
            option={option}
            value={values[option.name] ?? ""}
            onChange={(value) => change(option.name, value)}
            onRemove={() => remove(option.name)}
          />
        ))}
        <div class="replay-buttons">
          <label>
            Change{" "}
            <select
              value=""
              onChange={(event) => {
                const option = options.find(({ name }) => name === event.currentTarget.value);
                if (option) change(option.name, option.value);
              }}
            >
              <option value="">an option</option>
              {others.map(({ name }) => (
                <option key={name} value={name}>
                  {name}
                </option>
              ))}
            </select>
          </label>
          <button type="submit" disabled={changed.length === 0}>
            Run
          </button>
          {isRunning && (
            <button type="button" onClick={cancelDetection}>
              Cancel
            </button>
          )}
        </div>
      </form>
      {second && <Outcome second={second} />}
    </section>
  );
}

interface OptionInputProps {
  option: Option;
  value: string;
  onChange: (value: string) => void;
  onRemove: () => void;
}

function OptionInput({ option, value, onChange, onRemove }: OptionInputProps) {
  const id = `option-${option.name}`;
  const isFlag = option.value === "true" || option.value === "false";
  return (
    <div class="option">
      <label for={id}>
        <b>{option.name}</b> {option.meaning} (first run: {option.value}
        {option.unit === "1" ? "" : ` ${option.unit}`})
      </label>
      {isFlag ? (
        <select id={id} value={value} onChange={(event) => onChange(event.currentTarget.value)}>
          <option>true</option>
          <option>false</option>
        </select>
      ) : (
        <input
          id={id}
          value={value}
          maxLength={40}
          inputMode="decimal"
          onInput={(event) => onChange(event.currentTarget.value)}
        />
      )}
      <button type="button" aria-label={`Leave ${option.name} as it is`} onClick={onRemove}>
        ✕
      </button>
    </div>
  );
}

function Outcome({ second }: { second: SecondRun }) {
  const timeline = useStore((state) => state.timeline);
  const isBeside = useStore((state) => state.isBeside);
  if (!timeline) return null;
  const settings = second.settings.join(", ");
  switch (second.state) {
    case "none":
      return null;
    case "running":
      return (
        <p role="status">
          {second.done} of {timeline.times_ms.length} frames: {settings}
        </p>
      );
    case "cancelled":
      return <p role="status">Cancelled: {settings}</p>;
    case "failed":
      return <p role="alert">{second.error}</p>;
    case "done":
      return (
        <>
          <dl class="outcome">
            <dt>First run (above)</dt>
            <dd>{marksInWords(timeline.marks)}</dd>
            <dt>Second run (below): {settings}</dt>
            <dd>{marksInWords(second.marks)}</dd>
          </dl>
          <div class="replay-buttons">
            <button onClick={() => seekDifference(-1)}>◀ difference</button>
            <button onClick={() => seekDifference(1)}>difference ▶</button>
            <button aria-pressed={isBeside} onClick={toggleBeside}>
              Beside each other
            </button>
          </div>
        </>
      );
  }
}
