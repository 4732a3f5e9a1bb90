// Runs that another process flies: the server streams nothing of them unless it is asked again.
import { describe, expect, it } from 'vitest';

import { catalogue } from '../support/catalogue_bench';
import { sampleRun } from '../support/samples';

/** Watches a run of which 10 frames have been streamed. @param listed  as the list has it */
function watching(listed: () => Parameters<typeof sampleRun>[0], opened = true) {
  const bench = catalogue({ 'GET /runs': () => [200, { runs: [sampleRun(listed())] }] });
  const { session, socket } = bench;
  session.showRuns([{ id: 'r1', offset_ns: 5e9 }], null, null);
  const answer = () => {
    socket.receive({ type: 'ok', request: Number(socket.sent.at(-1)?.['request']) });
  };
  if (opened) answer();
  socket.receive({ type: 'run', run: sampleRun({ status: 'running', frames: 10 }) });
  const columns = { frame: [0, 1], t_ns: [0, 1] };
  socket.receive({ type: 'rows', run: 'r1', stream: 'truth', seq: 0, columns });
  const resumes = () => socket.sent.slice(1).filter(({ type }) => type === 'watch');
  return { ...bench, resumes };
}

describe('Catalogue', () => {
  it('reads a run on that grows while the stream sends nothing', async () => {
    let frames = 10;
    const { subject, socket, resumes } = watching(() => ({ status: 'running', frames }));
    await subject.readRuns();
    frames = 20;
    await subject.readRuns();
    expect(resumes()).toEqual([]);
    frames = 30;
    await subject.readRuns();
    expect(resumes()).toMatchObject([{ run: 'r1', offset_ns: 5e9, resume: { truth: 2 } }]);
    socket.receive({ type: 'run', run: sampleRun({ status: 'running', frames: 30 }) });
    await subject.readRuns();
    expect(resumes()).toHaveLength(1);
  });

  it('reads all of a run again, once, that has ended while the stream sent nothing', async () => {
    const { subject, socket, resumes, store } = watching(() => ({ status: 'completed' }));
    await subject.readRuns();
    expect(resumes()).toEqual([]);
    for (let list = 0; list < 4; list += 1) await subject.readRuns();
    expect(resumes()).toMatchObject([{ run: 'r1', offset_ns: 5e9, resume: {} }]);
    socket.receive({ type: 'run', run: sampleRun() });
    expect(store.state.run?.status).toBe('completed');
  });

  it('does not read on a run that the server is still opening', async () => {
    let frames = 10;
    const { subject, resumes } = watching(() => ({ status: 'running', frames }), false);
    for (frames = 20; frames < 60; frames += 10) await subject.readRuns();
    expect(resumes()).toEqual([]);
  });

  it('does not read again what the stream sends a little later', async () => {
    const { subject, socket, resumes } = watching(() => ({ status: 'completed' }));
    await subject.readRuns();
    socket.receive({ type: 'run', run: sampleRun() });
    await subject.readRuns();
    await subject.readRuns();
    expect(resumes()).toEqual([]);
  });
});
