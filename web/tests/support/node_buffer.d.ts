// What the tests use of Node.js, whose types are not installed.
declare module 'node:buffer' {
  export const File: typeof globalThis.File;
}
