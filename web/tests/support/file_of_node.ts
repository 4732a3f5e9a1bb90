// Node.js 18 has the browser's `File`, but does not make it global.
import { File } from 'node:buffer';

globalThis.File = File;
