// SPDX-License-Identifier: BSD-3-Clause
import type { ComponentChildren } from "preact";
import { showPanel } from "../actions";
import type { PanelName } from "../store";
import { useStore } from "../use_store";

/** A part of the page for which a phone has no room beside the image: it shows one at a time. */
export function Panel({ name, children }: { name: PanelName; children: ComponentChildren }) {
  const isShown = useStore((state) => state.panel === name);
  return (
    <div class={`panel panel-${name}`} data-shown={isShown}>
      {children}
    </div>
  );
}

/** Chooses the panel, where there is room for one only. */
export function PanelSwitch({ names }: { names: PanelName[] }) {
  const shown = useStore((state) => state.panel);
  return (
    <div class="panel-switch" role="group" aria-label="Panels">
      {names.map((name) => (
        <button key={name} aria-pressed={name === shown} onClick={() => showPanel(name)}>
          {name}
        </button>
      ))}
    </div>
  );
}
