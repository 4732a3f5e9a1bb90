import { defineConfig } from 'vitest/config';

export default defineConfig({
  // The tests read the style sheets.
  test: { css: true, setupFiles: ['tests/support/file_of_node.ts'] },
});
