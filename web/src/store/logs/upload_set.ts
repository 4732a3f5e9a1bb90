// What is uploaded of several chosen files: logs one by one, or a mapping with its CSV files.

export interface NamedFile {
  name: string;
  size: number;
}

/** Files of one upload, the mapping first. */
export type UploadSet<File extends NamedFile> = readonly [File, ...File[]];

const isMapping = ({ name }: NamedFile) => /\.json$/i.test(name);
const isPiece = ({ name }: NamedFile) => /\.(csv|txt)$/i.test(name);

/** @return the uploads, or why these files are none */
export function uploadSets<File extends NamedFile>(
  files: readonly File[],
): UploadSet<File>[] | string {
  const mappings = files.filter(isMapping);
  const pieces = files.filter(isPiece);
  const [mapping] = mappings;
  if (mapping === undefined) {
    if (pieces.length === 0) return files.map((file) => [file]);
    return `${pieces[0]?.name ?? ''}: CSV files are uploaded together with the mapping (.json) that names them`;
  }
  if (mappings.length > 1) return 'One mapping (.json) at a time, with its CSV files';
  if (pieces.length === 0) {
    return `${mapping.name}: choose the CSV files that this mapping names as well, all at once`;
  }
  const others = files.filter((file) => !isMapping(file) && !isPiece(file));
  return [[mapping, ...pieces], ...others.map((file): UploadSet<File> => [file])];
}

/** A name that the server permits; a space is no part of it. */
export function plainName(name: string): string {
  return name.replaceAll(/[^\w.-]/g, '_');
}

/** The parameters of the request. */
export function uploadQuery(files: UploadSet<NamedFile>): string {
  const [first] = files;
  if (files.length === 1) return `name=${encodeURIComponent(plainName(first.name))}`;
  // The mapping names its pieces: their names stay.
  const entries = files.map(({ name, size }, i) => `${i === 0 ? plainName(name) : name}:${size}`);
  return `files=${encodeURIComponent(entries.join(','))}`;
}
