# One image for any machine: it renders with a GPU if the host provides one, otherwise in software.
#   docker build -t overfly . && docker run --rm -p 127.0.0.1:8480:8480 overfly
# The log contains the URL to open, with the token.
FROM debian:bookworm-slim AS build
WORKDIR /opt/overfly
COPY scripts scripts
RUN scripts/install-packages build web run
COPY . .
RUN scripts/build && scripts/runtime-packages build/release/overfly > runtime-packages.txt

FROM debian:bookworm-slim
WORKDIR /opt/overfly
COPY scripts/packages.txt scripts/install-packages scripts/
COPY --from=build /opt/overfly/runtime-packages.txt .
RUN scripts/install-packages run \
 && apt-get install -y -qq --no-install-recommends ca-certificates curl tini $(cat runtime-packages.txt) \
 && rm -rf /var/lib/apt/lists/* \
 && useradd --create-home --uid 1000 overfly \
 && install -d -o overfly -g overfly /data /data/runs /data/cache /data/uploads /data/sweeps \
      /data/studies /data/scenarios /data/shared \
 && ln -s /opt/overfly/build/release/overfly /usr/local/bin/overfly
COPY --from=build /opt/overfly/build/release/overfly build/release/overfly
COPY --from=build /opt/overfly/web/dist web/dist
COPY scenarios scenarios
USER overfly
ENV OVERFLY_CACHE=/data/cache
VOLUME ["/data/runs", "/data/cache", "/data/uploads", "/data/sweeps", "/data/studies", "/data/scenarios"]
EXPOSE 8480
HEALTHCHECK --interval=30s --timeout=5s --start-period=10s \
  CMD printf 'header = "Authorization: Bearer %s"' "$(cat /data/token)" \
    | curl -fsS -K - http://127.0.0.1:8480/api/v1/health || exit 1
# The first process of a container must reap the orphans of estimators.
ENTRYPOINT ["tini", "-s", "--", "/opt/overfly/build/release/overfly"]
CMD ["serve", "--address", "0.0.0.0", "--token-file", "/data/token", "--runs", "/data/runs", "--sweeps", "/data/sweeps", "--studies", "/data/studies", "--uploads", "/data/uploads", "--saved-scenarios", "/data/scenarios", "--scenarios", "/opt/overfly/scenarios", "--data", "/data/shared", "--web", "/opt/overfly/web/dist"]
