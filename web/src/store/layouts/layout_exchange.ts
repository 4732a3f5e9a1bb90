// Exports own layouts to files and imports them, and reports the result to the viewer.
import { errorText } from '../../connection/rest_error';
import type { Notices } from '../notices';
import type { LayoutFile, ReadableFile } from './layout_file';
import { readLayoutFile, writeLayoutFile } from './layout_file';
import type { Layouts } from './layouts';
import { kMostOwn } from './layouts';

export class LayoutExchange {
  constructor(
    private readonly layouts: Layouts,
    private readonly notices: Notices,
  ) {}

  /** A file with the own layouts of these names. */
  export(names: readonly string[]): LayoutFile {
    return writeLayoutFile(this.layouts.copies(names));
  }

  /** Adds the layouts of a file, all or none. A single one is shown, unless that would undo changes. */
  async import(file: ReadableFile): Promise<void> {
    try {
      const read = await readLayoutFile(file);
      const names = this.layouts.add(read);
      if (names === null) {
        this.notices.error(
          `${file.name}: with its ${read.length} layouts there would be more than ${kMostOwn}. Delete some first.`,
        );
        return;
      }
      const renamed = read.flatMap(({ name }, i) => (names[i] === name ? [] : [name]));
      const kept =
        renamed.length === 0 ? '' : ` Your own ${renamed.join(', ')} differs and is kept.`;
      this.notices.info(`Imported from ${file.name}: ${names.join(', ')}.${kept}`);
      const [only] = names;
      if (only !== undefined && names.length === 1 && !this.layouts.isChanged) {
        this.layouts.choose(only);
      }
    } catch (error) {
      const problem = errorText(error);
      this.notices.error(`No layout was imported from ${file.name}. ${problem}`);
    }
  }
}
