import { defineConfig } from "vitest/config";

// One page after the other: pictures are drawn in software, on all cores.
export default defineConfig({
  test: {
    include: ["e2e/**/*.e2e.ts"],
    testTimeout: 120_000,
    hookTimeout: 300_000,
    fileParallelism: false,
  },
});
