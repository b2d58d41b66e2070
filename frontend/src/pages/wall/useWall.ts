/** The wall screen's line to the server: the link's code becomes a cookie, then one socket tells everything. */
import { useQuery } from "@tanstack/react-query";
import { useEffect, useRef, useState } from "react";
import { api, ApiProblem } from "@/api/client";
import { ME } from "@/api/queries";
import { LiveConnection } from "@/live/connection";
import { heldOf, standsAt } from "@/live/held";
import { statusOf } from "@/map/devices/device";
import type { FloorPlan } from "@/map/floor/floor";
import { interpolatePose, type RobotSource, type TimedPose } from "@/map/robots/robots";
import { doingWords } from "./doingWords";
import { applyMessage, codeOf, unpackMap, type Picture, type WallDevice, type WallMessage } from "./wall";

export type Line = "connecting" | "live" | "reconnecting" | "ended" | "many";

export interface Wall {
  readonly line: Line;
  readonly picture: Picture | null;
  readonly plan: FloorPlan | null;
  /** Milliseconds since 1970; null before the first news. */
  readonly heardAt: number | null;
  readonly robots: RobotSource;
}

const AGAIN_MS = 5_000;

const isRefusal = (error: unknown) => error instanceof ApiProblem && error.status >= 400 && error.status < 500;

/** Exchange the code in the address for a cookie, as often as it takes, and take it out of the address. */
function useOpening(): "opening" | "open" | "refused" {
  const [code] = useState(() => codeOf(location.hash));
  const opening = useQuery({
    queryKey: ["wall", code],
    queryFn: async ({ client }) => {
      await client.fetchQuery({ ...ME, retry: false }); // gives the token that opening needs
      await api.post("/wall/open", { code });
      return true;
    },
    enabled: code !== "",
    retry: (_, error) => !isRefusal(error),
    retryDelay: AGAIN_MS,
    staleTime: Infinity,
  });
  const done = code === "" || opening.isSuccess;
  useEffect(() => {
    if (done && location.hash) history.replaceState(history.state, "", location.pathname);
  }, [done]);
  if (done) return "open";
  return opening.isError ? "refused" : "opening";
}

const address = () => `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws/wall`;

/** Where robots were and are, so that they glide; of no interest to React. */
class Poses {
  readonly #pairs = new Map<string, { previous: TimedPose | null; current: TimedPose }>();
  #devices: readonly WallDevice[] = [];
  #isStopped = false;

  take(picture: Picture | null, at: number): void {
    const devices = picture?.devices ?? [];
    this.#devices = devices;
    this.#isStopped = picture?.stop.active ?? false;
    for (const { id, location: place } of devices) {
      const before = this.#pairs.get(id)?.current ?? null;
      const moved = !before || before.x !== place.x || before.y !== place.y || before.theta !== place.theta;
      if (moved) this.#pairs.set(id, { previous: before, current: { ...place, at } });
    }
  }

  readonly source: RobotSource = (now) =>
    this.#devices
      .filter((device) => device.kind === "robot")
      .map((known) => {
        const pair = this.#pairs.get(known.id);
        const isHeld = this.#isStopped && known.status === "busy" && standsAt(pair, now);
        const device = isHeld ? heldOf(known) : known;
        const pose = pair ? interpolatePose(pair.previous, pair.current, now) : device.location;
        const note = doingWords(device) || undefined;
        return { id: device.id, name: device.name, status: statusOf(device), note, ...pose };
      });
}

export function useWall(): Wall {
  const opening = useOpening();
  const [line, setLine] = useState<Line>("connecting");
  const [picture, setPicture] = useState<Picture | null>(null);
  const [plan, setPlan] = useState<FloorPlan | null>(null);
  const [heardAt, setHeardAt] = useState<number | null>(null);
  const [poses] = useState(() => new Poses());
  const last = useRef<Picture | null>(null);
  useEffect(() => {
    if (opening !== "open") return;
    const take = (message: WallMessage) => {
      setHeardAt(Date.now());
      if (message.type === "map") void unpackMap(message).then(setPlan);
      last.current = applyMessage(last.current, message);
      poses.take(last.current, performance.now());
      setPicture(last.current);
    };
    const connection = new LiveConnection(address(), {
      onMessage: (message) => take(message as WallMessage),
      onState: (state) => setLine(state === "crowded" ? "many" : state),
      onRefused: () => setLine("ended"),
    });
    return () => connection.close();
  }, [opening, poses]);
  return { line: opening === "refused" ? "ended" : line, picture, plan, heardAt, robots: poses.source };
}
