// SPDX-License-Identifier: BSD-3-Clause
import { defineConfig } from "vite";

// The built page goes into the repository and from there into the program. The content policy of the server lets in only what comes from it: no data: URLs.
export default defineConfig({
  build: { outDir: "page", emptyOutDir: true, target: "es2022", assetsInlineLimit: 0, modulePreload: { polyfill: false } },
  server: { proxy: { "/live": { target: "http://127.0.0.1:8090", ws: true } } },
  test: { include: ["src/**/*_test.ts"] },
});
