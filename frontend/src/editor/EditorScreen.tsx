/** The editor: a program drawn on its map, by several people at once. */
import { memo, useCallback, useEffect, useMemo, useState, useSyncExternalStore } from "react";
import { useTranslation } from "react-i18next";
import { useParams } from "react-router-dom";
import { missing } from "@/api/failed";
import { useDevices, useMe, useProgram, useSite, useSiteMap } from "@/api/queries";
import { mayOperate } from "@/api/roles";
import type { Device, Program, Site, User } from "@/api/types";
import { useAsHeld } from "@/live/held";
import { useSiteLive } from "@/live/site";
import { useEditorText, useScene } from "@/program/canvas/useScene";
import { openKeymap } from "@/shell/keys/keymap";
import { LoadProblem } from "@/shell/LoadProblem";
import { useTitle } from "@/shell/useTitle";
import classes from "./editor.module.css";
import { EditorWorkspace } from "./EditorWorkspace";
import type { Edit } from "./edits/edits";
import { inLanguage } from "./edits/fixes";
import { loadDrawer } from "./parts/Drawer";
import { SharedProgram } from "./shared/sharedProgram";
import { type OpenProgram, ProgramContext } from "./state/context";
import { usePeople, useShowSelection } from "./state/presence";
import { useQuietDevices } from "./state/quietDevices";
import { resetUi, useUi } from "./state/ui";

export function EditorScreen() {
  const { id } = useParams();
  const t = useEditorText();
  const program = useProgram(id);
  const slug = program.data?.site;
  const site = useSite(slug);
  const devices = useDevices(slug);
  const told = useAsHeld(devices.data);
  const me = useMe();
  useSiteLive(slug);
  useTitle(program.data?.name);
  const canEdit = site.data?.role === "author" || site.data?.role === "admin";
  const user = me.data?.user ?? null;
  useOwnKeys(user?.id);
  const [shared, openAnew] = useShared(id, site.data ? user?.id : undefined, canEdit);
  useComeAgain(shared);
  // The panels are on their way while the program is.
  useEffect(() => void loadDrawer().catch(() => {}), []);
  const failed = missing(program, site, devices);
  if (failed)
    return <Failed error={failed} again={() => void [program, site, devices].map((read) => read.refetch())} />;
  if (!program.data || !site.data || !told || !shared) return <p className={classes.wait}>{t("opening")}</p>;
  return (
    <Loaded
      program={program.data}
      site={site.data}
      devices={told}
      shared={shared}
      canEdit={canEdit}
      user={user}
      openAnew={openAnew}
    />
  );
}

/** The keys of who is signed in. */
function useOwnKeys(person: number | undefined): void {
  useEffect(() => {
    if (person !== undefined) openKeymap(String(person));
  }, [person]);
}

function Failed({ error, again }: { error: Error; again: () => void }) {
  return (
    <main className={classes.wait}>
      <LoadProblem error={error} again={again} />
    </main>
  );
}

/** The shared document for as long as this program is on the screen, and a way to begin with it anew. */
function useShared(
  id: string | undefined,
  person: number | undefined,
  canEdit: boolean,
): [SharedProgram | null, () => void] {
  const [shared, setShared] = useState<SharedProgram | null>(null);
  const [round, setRound] = useState(0);
  const openAnew = useCallback(() => setRound((before) => before + 1), []);
  useEffect(() => {
    if (!id || person === undefined) return;
    resetUi();
    const opened = new SharedProgram(id, socketAddress(), String(person));
    setShared(opened);
    return () => {
      setShared(null);
      opened.close();
    };
  }, [id, person, canEdit, round]);
  return [shared, openAnew];
}

const SIGNED_OUT = 4401;
/** So long the answer that brings a new password's key may take. */
const NEW_KEY_MS = 500;

/** Whoever is still signed in when the server ends a connection for its session, with a new password say, comes again. */
function useComeAgain(shared: SharedProgram | null): void {
  const { refetch } = useMe();
  useEffect(() => {
    if (!shared) return;
    let timer: ReturnType<typeof setTimeout> | undefined;
    const look = () => {
      if (shared.getSaving().closedWith !== SIGNED_OUT || timer !== undefined) return;
      timer = setTimeout(() => {
        timer = undefined;
        void refetch().then(({ data }) => {
          if (data?.user && shared.getSaving().closedWith === SIGNED_OUT) shared.connectAgain();
        });
      }, NEW_KEY_MS);
    };
    const stop = shared.subscribeSaving(look);
    return () => {
      stop();
      clearTimeout(timer);
    };
  }, [shared, refetch]);
}

/** y-websocket puts the program's id behind it. */
function socketAddress(): string {
  return `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws/program`;
}

function useShowUser(shared: SharedProgram, user: User | null): void {
  useShowSelection(
    shared,
    useMemo(() => (user ? { ...user } : undefined), [user]),
  );
}

/** Drawn anew for what is open, not for each pose that a robot tells. */
const Workspace = memo(EditorWorkspace);

interface LoadedProps {
  program: Program;
  site: Site;
  devices: Device[];
  shared: SharedProgram;
  canEdit: boolean;
  user: User | null;
  openAnew: () => void;
}

function Loaded({ program, site, devices: live, shared, canEdit, user, openAnew }: LoadedProps) {
  const map = useSiteMap(site.has_map ? site.slug : undefined);
  const compiled = useSyncExternalStore(shared.compiled.subscribe, shared.compiled.get);
  const document = useSyncExternalStore(shared.subscribe, shared.getDocument);
  const devices = useQuietDevices(live);
  const collapsed = useUi((ui) => ui.collapsed);
  const { loaded } = useSyncExternalStore(shared.subscribeSaving, shared.getSaving);
  const draws = canEdit && loaded;
  const plan = map.data ?? null;
  const parts = useScene({
    site: site.slug,
    plan,
    document,
    compiled,
    devices,
    collapsed,
  });
  const people = usePeople(shared);
  const { language } = useTranslation().i18n;
  useShowUser(shared, user);
  const open = useMemo<OpenProgram>(() => {
    const { scene, surroundings, t } = parts;
    return {
      program,
      site,
      plan,
      devices,
      shared,
      document,
      compiled,
      diagnostics: inLanguage(compiled?.diagnostics ?? [], language),
      scene,
      surroundings,
      speaker: { document, surroundings, t },
      t,
      people,
      loaded,
      canEdit: draws,
      canRun: loaded && mayOperate(site.role),
      apply: (edits: readonly Edit[]) => {
        if (draws) shared.apply(edits);
      },
      openAnew,
    };
  }, [program, site, plan, devices, shared, document, compiled, parts, people, loaded, draws, language, openAnew]);
  return (
    <ProgramContext value={open}>
      <Workspace />
    </ProgramContext>
  );
}
