// What is uploaded of several chosen files: trajectories, KITTI poses joined with their times, and
// flight logs.
import { errorText } from '../../connection/rest_error';
import type { UploadSet } from '../logs/upload_set';
import { uploadQuery, uploadSets } from '../logs/upload_set';
import { isKitti, tumFromKitti } from './kitti_times';

export type PlannedUpload =
  | { kind: 'trajectory'; name: string; body: Blob }
  /** `query` as of RestClient.uploadLog() */
  | { kind: 'log'; name: string; query: string; body: Blob };

const kBeginning_bytes = 4096;
/** As the server's limit for a trajectory. */
const kMostJoined_bytes = 64 * 2 ** 20;

const isLog = ({ name }: File) => /\.(tlog|bin|ulg|mcap|bag|active|lcm|log)$/i.test(name);
const isMapping = ({ name }: File) => /\.json$/i.test(name);
const isPart = ({ name }: File) => /\.(json|csv|txt)$/i.test(name);
const isTimes = ({ name }: File) => /(^|[._-])times\.txt$/i.test(name);

/** Throws an Error that names the file if files belong together of which some are missing. */
export async function uploadPlan(files: readonly File[]): Promise<PlannedUpload[]> {
  // A mapping comes with its CSV files; without one they are trajectories.
  const mapped = files.some(isMapping);
  const belongsToLog = (file: File) => isLog(file) || (mapped && isPart(file));
  const sets = uploadSets(files.filter(belongsToLog));
  if (typeof sets === 'string') throw new Error(sets);
  const trajectories = await trajectoryPlan(files.filter((file) => !belongsToLog(file)));
  return [...trajectories, ...sets.map(logPlan)];
}

function logPlan(files: UploadSet<File>): PlannedUpload {
  const [first] = files;
  const body = files.length === 1 ? first : new Blob([...files]);
  return { kind: 'log', name: first.name, query: uploadQuery(files), body };
}

async function trajectoryPlan(files: readonly File[]): Promise<PlannedUpload[]> {
  const plain = (file: File): PlannedUpload => ({
    kind: 'trajectory',
    name: file.name,
    body: file,
  });
  const times = files.filter(isTimes);
  const poses = files.filter((file) => !isTimes(file));
  const [timesFile, second] = times;
  if (timesFile === undefined) return poses.map(plain);
  if (second !== undefined)
    throw new Error(`${second.name}: one times file at a time, with its KITTI poses`);
  const stamps = await textOf(timesFile);
  let joined = 0;
  const plan: PlannedUpload[] = [];
  for (const file of poses) {
    if (!isKitti(await textOf(file.slice(0, kBeginning_bytes), file.name))) {
      plan.push(plain(file));
      continue;
    }
    joined += 1;
    const name = `${file.name.replace(/\.[^.]*$/, '')}.tum`;
    const text = joinedText(file, await textOf(file), stamps);
    plan.push({ kind: 'trajectory', name, body: new Blob([text]) });
  }
  if (joined === 0) {
    throw new Error(`${timesFile.name}: choose the KITTI poses that it belongs to as well`);
  }
  return plan;
}

async function textOf(file: Blob, name = file instanceof File ? file.name : ''): Promise<string> {
  if (file.size > kMostJoined_bytes) {
    const most = kMostJoined_bytes / 2 ** 20;
    throw new Error(`${name}: has more than ${most} MiB, the limit for KITTI poses and times`);
  }
  try {
    return await file.text();
  } catch (error) {
    throw new Error(`${name}: ${errorText(error)}`);
  }
}

function joinedText(file: File, text: string, stamps: string): string {
  try {
    return tumFromKitti(text, stamps);
  } catch (error) {
    throw new Error(`${file.name}: ${errorText(error)}`);
  }
}
