/** The live view of one site: a socket shared by all who look, kept while anybody does. */
import { useQueryClient, type QueryClient } from "@tanstack/react-query";
import { useEffect } from "react";
import { keys } from "@/api/queries";
import type { Device, Me, Site } from "@/api/types";
import { LiveConnection } from "./connection";
import { SiteFeed } from "./feed";
import type { LiveMessage } from "./messages";
import { forgetReadings, recordDevice } from "./readings";
import { EMPTY, isLookedAt, setLive, useLiveStore, type Connection, type LiveState } from "./store";

interface Session {
  watchers: number;
  /** Let the live store be about this site, with what is known of it and of its line. */
  show(): void;
  end(): void;
}

const LINGER_MS = 2000;
/** So long a screen may take to come on a slow line. */
const AHEAD_MS = 20_000;
const SIGNED_OUT = 4401;
/** So long the answer that brings the new key may take. */
const NEW_KEY_MS = 500;
const sessions = new Map<string, Session>();

/** Watch a site while the caller is on the screen; nothing happens while the slug is not known. */
export function useSiteLive(slug: string | undefined): void {
  const queries = useQueryClient();
  useEffect(() => (slug ? watch(slug, queries) : undefined), [slug, queries]);
}

/**
 * Watch a site while its screen is on its way: what the screen asks for after the greeting needs no second look.
 *
 * Who is not signed in or no member is refused, and nothing stays of it.
 */
export function watchAhead(slug: string, queries: QueryClient): void {
  const session = sessionOf(slug, queries);
  setTimeout(() => endIdle(slug, session), AHEAD_MS);
}

function watch(slug: string, queries: QueryClient): () => void {
  const session = sessionOf(slug, queries);
  session.watchers += 1;
  return () => {
    session.watchers -= 1;
    setTimeout(() => endIdle(slug, session), LINGER_MS);
  };
}

/** Forget what was told to a person who is signed in here no more; `isAnybody`: another is, and looks at the site. */
export function forgetLive(isAnybody: boolean): void {
  const { site, connection, lostAt } = useLiveStore.getState();
  forgetReadings();
  useLiveStore.setState(isAnybody ? { ...EMPTY, site, connection, lostAt } : EMPTY);
  if (isAnybody) return;
  for (const session of sessions.values()) session.end();
  sessions.clear();
}

/** The session of a site, which is looked at from now on; those of others that nobody watches end. */
function sessionOf(slug: string, queries: QueryClient): Session {
  for (const [other, session] of sessions) if (other !== slug) endIdle(other, session);
  const session = sessions.get(slug) ?? begin(slug, queries);
  sessions.set(slug, session);
  session.show();
  return session;
}

function endIdle(slug: string, session: Session): void {
  if (session.watchers > 0 || sessions.get(slug) !== session) return;
  sessions.delete(slug);
  session.end();
}

function begin(slug: string, queries: QueryClient): Session {
  let line: Pick<LiveState, "connection" | "lostAt"> = { connection: "connecting", lostAt: null };
  const setConnection = (connection: Connection): void => {
    if (line.connection === connection) return;
    line = { connection, lostAt: connection === "reconnecting" ? (line.lostAt ?? Date.now()) : null };
    setLive(slug, line);
  };
  const feed = new SiteFeed(slug, queries);
  let ended = false;
  const connect = (): LiveConnection =>
    new LiveConnection(socketAddress(slug), {
      onMessage: (message) => feed.take(message as LiveMessage),
      onState: setConnection,
      onRefused: (code) => (code === SIGNED_OUT && session.watchers > 0 ? void comeAgain() : refuse(code)),
    });
  /** A new password gives this browser's session another key: who is still signed in with that one comes again. */
  const comeAgain = async (): Promise<void> => {
    setConnection("connecting");
    await new Promise((done) => setTimeout(done, NEW_KEY_MS));
    await queries.refetchQueries({ queryKey: keys.me });
    if (!ended && queries.getQueryData<Me>(keys.me)?.user) connection = connect();
  };
  /** Who is no member any more is told so; whoever looks at the site after that asks the server again. */
  const refuse = (code: number): void => {
    const wasMember = queries.getQueryData(keys.site(slug)) !== undefined;
    if (sessions.get(slug) === session) sessions.delete(slug);
    session.end();
    if (code === SIGNED_OUT || !wasMember) return;
    setConnection("refused");
    forgetSite(slug, queries);
  };
  let connection = connect();
  const unfollow = followCaches(slug, queries);
  const session: Session = {
    watchers: 0,
    show() {
      if (isLookedAt(slug)) return setLive(slug, line);
      forgetReadings();
      useLiveStore.setState({ ...EMPTY, site: slug, ...line });
      copyKnown(slug, queries);
    },
    end() {
      ended = true;
      connection.close();
      feed.end();
      unfollow();
    },
  };
  return session;
}

/** What an open program stands on: whoever has drawn in it takes their version along from there. */
const STANDS_ON = ["site", "devices", "map"];

/** Remove what is known of a site; what is on the screen goes with it. A key begins with the name of its cache. */
function forgetSite(slug: string, queries: QueryClient): void {
  queries.removeQueries({
    predicate: ({ queryKey }) => queryKey.indexOf(slug) > 0 && !STANDS_ON.includes(String(queryKey[0])),
  });
  void queries.invalidateQueries({ queryKey: keys.sites });
}

function socketAddress(slug: string): string {
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  return `${scheme}://${location.host}/ws/site/${encodeURIComponent(slug)}`;
}

/** What is fetched by HTTP goes into the live store too, so that it is complete from the first moment. */
function followCaches(slug: string, queries: QueryClient): () => void {
  copyKnown(slug, queries);
  return queries.getQueryCache().subscribe((event) => {
    if (event.type !== "updated" || event.action.type !== "success") return;
    const [name, of] = event.query.queryKey as [string, string];
    if (of !== slug) return;
    if (name === "devices") copyDevices(slug, event.query.state.data as Device[]);
    if (name === "site") copyStop(slug, event.query.state.data as Site);
  });
}

function copyKnown(slug: string, queries: QueryClient): void {
  copyDevices(slug, queries.getQueryData<Device[]>(keys.devices(slug)));
  copyStop(slug, queries.getQueryData<Site>(keys.site(slug)));
}

function copyDevices(slug: string, devices: Device[] | undefined): void {
  if (!devices || !isLookedAt(slug)) return;
  for (const device of devices) recordDevice(device, performance.now());
  setLive(slug, { deviceById: Object.fromEntries(devices.map((device) => [device.id, device])) });
}

function copyStop(slug: string, site: Site | undefined): void {
  if (site) setLive(slug, { stop: site.stop });
}
