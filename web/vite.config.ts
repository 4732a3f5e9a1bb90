import { defineConfig, loadEnv } from 'vite';

// `npm run dev` serves the dashboard with hot reload and passes the API on to a running server.
export default defineConfig(({ mode }) => {
  const { OVERFLY_URL = 'http://127.0.0.1:8480' } = loadEnv(mode, '.', 'OVERFLY_');
  const { origin, searchParams } = new URL(OVERFLY_URL);
  const token = searchParams.get('token');
  const headers = token === null ? {} : { Authorization: `Bearer ${token}` };
  return {
    base: './',
    build: { target: 'es2022', assetsInlineLimit: 0, sourcemap: false },
    // By number: a bare container may not know the name localhost.
    server: { host: '127.0.0.1', proxy: { '/api': { target: origin, ws: true, headers } } },
  };
});
