// SPDX-License-Identifier: BSD-3-Clause
import { offeredPages, pageName, showPage } from "../pages";
import { useStore } from "../use_store";

/** The pages, where there is more than one. */
export function PageSwitch() {
  const page = useStore((state) => state.page);
  useStore((state) => state.hello);
  useStore((state) => state.studyReplay);
  const pages = offeredPages();
  if (pages.length < 2) return null;
  return (
    <nav class="pages" aria-label="Pages">
      {pages.map((one) => (
        <button
          key={one}
          aria-current={one === page ? "page" : undefined}
          onClick={() => showPage(one)}
        >
          {pageName(one)}
        </button>
      ))}
    </nav>
  );
}
