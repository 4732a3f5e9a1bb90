// A server inside the page: replays a made-up flight.
import type { Socket } from '../src/connection/stream_client';
import type { ClientMessage, PictureStream, Playback, PoseValues } from '../src/protocol/messages';
import { encodePicture } from '../src/protocol/parse';
import type { JsonObject, Run } from '../src/protocol/rest_types';

const N = 4340;
const RATE = 31;
const tOf = (k: number) => Math.round((k * 1e9) / RATE);

function truth(k: number): PoseValues {
  const t = k / RATE;
  const out = t < 60;
  const roll = out ? 0 : 45 * Math.sin((t - 60) * 0.5);
  const yaw = out ? 180 : 180 + 60 * Math.sin((t - 60) * 0.25);
  return {
    x_m: 100 + (out ? 0 : 200 * Math.sin((t - 60) * 0.1)),
    y_m: out ? 1500 - 25 * t : 24 * (t - 60),
    z_m: 300 + 3 * Math.sin(t / 7),
    roll_deg: roll,
    pitch_deg: 2 + Math.cos(t),
    yaw_deg: ((yaw + 180) % 360) - 180,
  };
}
function estimate(k: number): { state: string; pose: PoseValues | null } {
  if (k < 40) return { state: 'INITIALISING', pose: null };
  if (k > 2600 && k < 2700) return { state: 'LOST', pose: null };
  const p = truth(k);
  const e = k / 600;
  return {
    state: 'TRACKING',
    pose: {
      ...p,
      x_m: p.x_m + e * Math.sin(k / 90) * 3,
      y_m: p.y_m + e,
      z_m: p.z_m - e,
      roll_deg: p.roll_deg + Math.sin(k),
      yaw_deg: p.yaw_deg + 1,
    },
  };
}
const kDoc: JsonObject = {
  title: 'The course over the built-in airfield',
  seed: 1,
  world: { builtin: { seed: 1 } },
  flight: {
    course: { airspeed_m_s: 25, roll_rate_max_deg_s: 45, height_agl_m: 300, bank_max_deg: 45 },
  },
  estimators: [{ name: 'feature', type: 'feature' }],
  pacing: 'lockstep',
  duration_s: null,
};

export class FakeServer {
  runs: Run[] = [
    this.makeRun('20261121-083000-course', 'completed', N),
    this.makeRun('20261120-171200-mcmillan', 'failed', 300),
  ];
  private makeRun(id: string, status: Run['status'], frames: number): Run {
    return {
      id,
      scenario: 'course',
      title: 'The course over the built-in airfield',
      status,
      created_utc: '2026-11-21T08:30:00Z',
      error:
        status === 'failed'
          ? 'world.imagery.0.file: terrain/mcmillan/ortho.tif cannot be opened'
          : null,
      duration_ns: tOf(N),
      frames,
      frames_total: N,
      pacing: 'lockstep',
      estimators: ['feature'],
      attribution: 'Built-in world, seed 1',
    };
  }
  openSocket(): Socket {
    return new FakeSocket(this);
  }
  async fetch(url: string, init?: RequestInit): Promise<Response> {
    await Promise.resolve();
    const json = (v: unknown, status = 200) => new Response(JSON.stringify(v), { status });
    if (url.endsWith('/scenarios'))
      return json({
        scenarios: [
          {
            name: 'course',
            title: kDoc['title'],
            description:
              '3.3 km: southbound initialisation leg, turn, oscillating return. Needs no data.',
            error: null,
          },
          {
            name: 'mcmillan_course',
            title: 'The course over McMillan airfield',
            description: 'Real.',
            error: 'data missing',
          },
        ],
      });
    if (url.includes('/scenarios/')) return json(kDoc);
    if (init?.method === 'POST' && url.endsWith('/runs')) {
      const { overrides } = JSON.parse(init.body as string) as {
        overrides: Record<string, number>;
      };
      if ((overrides['flight.course.airspeed_m_s'] ?? 25) > 60)
        return json(
          {
            error: {
              code: 'invalid_argument',
              message: 'flight.course.airspeed_m_s = 99: must be in [5, 60]',
            },
          },
          400,
        );
      const run = this.makeRun(`run-${this.runs.length}`, 'running', 200);
      this.runs.unshift(run);
      return json(run, 201);
    }
    if (url.endsWith('/runs')) return json({ runs: this.runs });
    if (init?.method === 'DELETE') {
      this.runs = this.runs.filter((r) => !url.endsWith(r.id));
      return new Response(null, { status: 204 });
    }
    return json({});
  }
}

class FakeSocket implements Socket {
  binaryType: BinaryType = 'blob';
  onopen: ((event: Event) => void) | null = null;
  onmessage: ((event: MessageEvent) => void) | null = null;
  onclose: ((event: CloseEvent) => void) | null = null;
  private run: Run | null = null;
  private streams: (PictureStream & { id: number })[] = [];
  private view: Record<string, unknown> = { mode: 'chase', width_px: 640, height_px: 480 };
  private pb = { frame: 0, playing: false, live: false, speed: 1, loop: false };
  private pos = 0;
  private timer = 0;
  private seq = 0;
  constructor(private readonly server: FakeServer) {
    setTimeout(
      () => this.tell({ type: 'hello', protocol: 1, server: 'overfly 0.1.0', connection: 'c1' }),
      20,
    );
  }
  close(): void {
    clearInterval(this.timer);
  }
  private tell(m: unknown): void {
    this.onmessage?.(new MessageEvent('message', { data: JSON.stringify(m) }));
  }
  send(text: string): void {
    const m = JSON.parse(text) as ClientMessage & { request: number };
    this.tell({ type: 'ok', request: m.request });
    switch (m.type) {
      case 'attach':
        this.attach(m.run);
        break;
      case 'subscribe':
        this.streams = m.streams.map((s, id) => ({ ...s, id }));
        this.tell({ type: 'streams', streams: this.streams });
        break;
      case 'view':
        Object.assign(this.view, m);
        break;
      case 'play':
        this.pb.playing = true;
        break;
      case 'pause':
        this.pb.playing = false;
        this.pb.live = false;
        break;
      case 'seek':
        this.pb.live = false;
        this.pos = 'frame' in m ? m.frame : Math.round((m.t_ns * RATE) / 1e9);
        break;
      case 'step':
        this.pb.playing = false;
        this.pos += m.frames;
        break;
      case 'speed':
        this.pb.speed = m.value;
        break;
      case 'loop':
        this.pb.loop = m.value;
        break;
      case 'live':
        this.pb.live = true;
        break;
    }
    if (m.type !== 'subscribe') this.show();
  }
  private attach(id: string): void {
    this.run = this.server.runs.find((r) => r.id === id) ?? null;
    const run = this.run;
    if (run === null) return;
    this.tell({ type: 'run', run });
    this.pos = 0;
    this.pb.live = this.pb.playing = run.status === 'running';
    this.rows(0, run.frames);
    this.tell({
      type: 'rows',
      stream: 'log',
      seq: 0,
      columns: {
        t_ns: [0, 1.3e9, 84e9],
        level: ['info', 'info', 'warning'],
        text: [
          'World built-in seed 1, EGL llvmpipe',
          'feature: initialised from a homography, 412 points',
          'feature: lost track at frame 2601',
        ],
      },
    });
    if (run.status === 'completed')
      this.tell({
        type: 'metrics',
        metrics: {
          camera: { frames: N, texels_per_pixel: { min: 0.3, median: 0.44 } },
          estimators: {
            feature: {
              outcome: 'LOST',
              outcome_time_s: 83.9,
              coverage: 0.967,
              dropped_frames: 0,
              alignments: {
                init_scale: {
                  scale: 41.2031,
                  position_rmse_m: 3.42,
                  rotation_rmse_deg: 0.61,
                  position_rmse_hold_m: 3.9,
                  rotation_euler_norm_rmse_deg: 0.72,
                },
                sim3: {
                  scale: 41.5,
                  position_rmse_m: 1.1,
                  rotation_rmse_deg: 0.4,
                  position_rmse_hold_m: 1.9,
                  rotation_euler_norm_rmse_deg: 0.5,
                },
              },
            },
          },
        },
      });
    clearInterval(this.timer);
    this.timer = window.setInterval(() => this.tick(), 50);
  }
  private rows(a: number, b: number): void {
    const truths = Array.from({ length: b - a }, (_, i) => ({
      frame: a + i,
      t_ns: tOf(a + i),
      ...truth(a + i),
      texels_per_pixel: 0.44,
      void_fraction: 0,
    }));
    const ests = Array.from({ length: b - a }, (_, i) => {
      const e = estimate(a + i);
      return {
        frame: a + i,
        t_ns: tOf(a + i),
        state: e.state,
        ...(e.pose ?? {
          x_m: null,
          y_m: null,
          z_m: null,
          roll_deg: null,
          pitch_deg: null,
          yaw_deg: null,
        }),
        latency_ms: 20,
      };
    });
    const columns = (rows: object[]) =>
      Object.fromEntries(
        Object.keys(rows[0] ?? {}).map((k) => [
          k,
          rows.map((r) => (r as Record<string, unknown>)[k]),
        ]),
      );
    this.tell({ type: 'rows', stream: 'truth', seq: a, columns: columns(truths) });
    this.tell({ type: 'rows', stream: 'estimate/feature', seq: a, columns: columns(ests) });
  }
  private tick(): void {
    const run = this.run;
    if (run === null) return;
    if (run.status === 'running') {
      const a = run.frames;
      run.frames = Math.min(N, a + 3);
      if (run.frames > a) this.rows(a, run.frames);
      if (run.frames === N) run.status = 'completed';
      if (a % 15 === 0) this.tell({ type: 'run', run: { ...run } });
    }
    if (!this.pb.playing && !this.pb.live) return;
    this.pos = this.pb.live ? run.frames - 1 : this.pos + (RATE / 20) * this.pb.speed;
    this.show();
  }
  private show(): void {
    const run = this.run;
    if (run === null) return;
    this.pos = Math.max(0, Math.min(run.frames - 1, this.pos));
    this.pb.frame = Math.floor(this.pos);
    const k = this.pb.frame;
    const p: Playback = {
      ...this.pb,
      t_ns: tOf(k),
      begin_ns: 0,
      end_ns: tOf(run.frames - 1),
      truth: truth(k),
      estimates: { feature: estimate(k) },
    };
    this.tell({ type: 'playback', ...p });
    for (const s of this.streams) void this.picture(s, k);
  }
  private async picture(s: PictureStream & { id: number }, k: number): Promise<void> {
    const w = s.name === 'scene' ? Number(this.view['width_px']) : 640;
    const hgt = s.name === 'scene' ? Number(this.view['height_px']) : 480;
    const c = new OffscreenCanvas(w, hgt);
    const g = c.getContext('2d');
    if (g === null) return;
    g.fillStyle = s.name === 'scene' ? '#7d93a8' : '#555';
    g.fillRect(0, 0, w, hgt);
    for (let i = 0; i < 300; i += 1) {
      const x = (i * 7919 + k * 3) % w;
      const y = (i * 104729 + k * 2) % hgt;
      g.fillStyle = `hsl(${(i * 37) % 110} ${s.name === 'scene' ? 30 : 0}% ${25 + (i % 40)}%)`;
      g.fillRect(x, y, 40, 25);
    }
    g.fillStyle = '#fff';
    g.font = '20px sans-serif';
    g.fillText(`${s.name} frame ${k} ${String(this.view['mode'])}`, 20, 40);
    const bytes = new Uint8Array(
      await (await c.convertToBlob({ type: 'image/jpeg', quality: 0.75 })).arrayBuffer(),
    );
    this.onmessage?.(
      new MessageEvent('message', {
        data: encodePicture(
          {
            streamId: s.id,
            sequence: this.seq++,
            frame: k,
            t_ns: tOf(k),
            width_px: w,
            height_px: hgt,
            grey: false,
            live: false,
          },
          bytes,
        ),
      }),
    );
  }
}
