// SPDX-License-Identifier: BSD-3-Clause
import { showPage } from "../calibration_actions";
import type { Page } from "../store";
import { useStore } from "../use_store";

const names: Record<Page, string> = { watch: "Replay", calibration: "Calibration" };

/** The pages of a recording; a flight has one only. */
export function PageSwitch() {
  const page = useStore((state) => state.page);
  const isOffered = useStore((state) => state.hello?.offers.includes("calibrate") ?? false);
  if (!isOffered) return null;
  return (
    <nav class="pages" aria-label="Pages">
      {(Object.keys(names) as Page[]).map((one) => (
        <button
          key={one}
          aria-current={one === page ? "page" : undefined}
          onClick={() => showPage(one)}
        >
          {names[one]}
        </button>
      ))}
    </nav>
  );
}
