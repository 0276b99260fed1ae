// SPDX-License-Identifier: BSD-3-Clause
import { useState } from "preact/hooks";
import { changesIn, saveSettings, type Setting, type Settings } from "../settings";
import { useStore } from "../use_store";
import "./settings_panel.css";

/** The longest value that the program takes with its name. */
const maxLength = 460;

/** Camera, exposure and target, to be changed for the next start. */
export function SettingsPanel() {
  const settings = useStore((state) => (state.status?.over ? null : state.settings));
  if (!settings) return null;
  return (
    <details class="settings">
      <summary>Settings</summary>
      <SettingsForm settings={settings} />
    </details>
  );
}

function SettingsForm({ settings }: { settings: Settings }) {
  const [inputs, setInputs] = useState<Record<string, string>>({});
  const changes = changesIn(settings.settings, inputs);
  const save = (event: Event) => {
    event.preventDefault();
    saveSettings(changes);
  };
  return (
    <form aria-label="Settings" onSubmit={save}>
      <p class="hint">
        {settings.file === ""
          ? "Start kestrel fly with --config FILE to change settings here."
          : `For the next start of kestrel fly, in ${settings.file}:`}
      </p>
      <fieldset disabled={settings.file === ""}>
        {settings.settings.map((one) => (
          <SettingInput
            key={one.name}
            setting={one}
            input={inputs[one.name] ?? one.value}
            onInput={(value) => setInputs({ ...inputs, [one.name]: value })}
          />
        ))}
      </fieldset>
      <div class="settings-end">
        <button type="submit" disabled={changes.length === 0}>
          Save
        </button>
        {settings.error !== "" && <p role="alert">Not saved: {settings.error}</p>}
        {settings.saved !== "" && <p role="status">{settings.saved}</p>}
      </div>
    </form>
  );
}

interface SettingInputProps {
  setting: Setting;
  input: string;
  onInput: (value: string) => void;
}

function SettingInput({ setting, input, onInput }: SettingInputProps) {
  const { name, label, unit, meaning, choices, given } = setting;
  const hint = `setting-${name}`;
  return (
    <div>
      <label>
        {label}
        {unit !== "" && `, ${unit}`}
        {choices.length > 0 ? (
          <select value={input} disabled={given} aria-describedby={hint} onChange={(event) => onInput(event.currentTarget.value)}>
            {choices.map((choice) => (
              <option key={choice}>{choice}</option>
            ))}
          </select>
        ) : (
          <input
            value={input}
            disabled={given}
            aria-describedby={hint}
            maxLength={maxLength}
            inputMode={unit === "" ? "text" : "decimal"}
            autocapitalize="off"
            spellcheck={false}
            onInput={(event) => onInput(event.currentTarget.value)}
          />
        )}
      </label>
      <p id={hint} class="hint">
        {given ? "given on the command line" : meaning}
      </p>
    </div>
  );
}
