/** Where things stand on the editor's screen. */
import { useMediaQuery, useViewportSize } from "@mantine/hooks";
import { type CSSProperties, lazy, Suspense, useEffect, useMemo } from "react";
import { beside, useFetchLater } from "@/design/useFetchLater";
import type { Insets } from "@/map/plane/projection";
import { useTour } from "./beginning/tourStops";
import { Announcer } from "./keyboard/Announcer";
import { ModeBar } from "./keyboard/ModeBar";
import { useOthersEdits } from "./keyboard/othersEdits";
import { useModeKeys } from "./keyboard/useModeKeys";
import classes from "./editor.module.css";
import { loadCorners } from "./canvas/CornerHandles";
import { ContextMenu } from "./commands/ContextMenu";
import { useCommandKeys } from "./commands/keys";
import { EditorMap } from "./EditorMap";
import { useClipboard } from "./gestures/clipboard";
import { loadPasting, pasteIfScript } from "./gestures/pasting";
import { Inspector, loadPanels } from "./inspector/Inspector";
import { Dialogs } from "./dialogs/Dialogs";
import { Drawer } from "./parts/Drawer";
import { EditorTop } from "./parts/EditorTop";
import { NotTaken } from "./parts/NotTaken";
import { Unopened } from "./parts/Unopened";
import { HelpSentence, ProgramButton, Toast } from "./parts/Overlays";
import { QuickAdd } from "./parts/QuickAdd";
import { ToolRail } from "./parts/ToolRail";
import { ROW_PX, useToolRows } from "./parts/toolRows";
import { useOpenProgram } from "./state/context";
import { resetGestures, useGestures } from "./state/gestures";
import { useUi } from "./state/ui";
import { useRunning } from "./state/useRunning";

const loadZoneForm = () => import("./zones/ZoneForm");
const loadEmptyProgram = () => import("./beginning/EmptyProgram");
const loadNextSteps = () => import("./beginning/NextSteps");
const EmptyProgram = lazy(async () => ({ default: (await loadEmptyProgram()).EmptyProgram }));
const NextSteps = lazy(async () => ({ default: (await loadNextSteps()).NextSteps }));
const Tour = lazy(async () => ({ default: (await import("./beginning/Tour")).Tour }));
const PaletteOffer = beside(async () => (await import("./commands/offer")).PaletteOffer);
const loadComments = () => import("./comments/CommentsPanel");
const ZoneForm = lazy(async () => ({ default: (await loadZoneForm()).ZoneForm }));
/** Fetched once the program has come, so that the first form opens and the first script is pasted at once. */
const LATER = [loadPanels, loadZoneForm, loadComments, loadCorners, loadPasting];

const FITTED: Insets = { left: 100, right: 336, top: 34, bottom: 300 };

export function EditorWorkspace() {
  useGestureInput();
  useFetchLater(LATER);
  const small = useMediaQuery("(max-width: 1179px)") ?? false;
  const drawerOpen = useUi((ui) => ui.drawer.open);
  const tall = useUi((ui) => ui.drawer.open && ui.tallDrawer);
  const half = useViewportSize().height / 2;
  const selected = useUi((ui) => ui.selected.length > 0);
  const resting = useUi((ui) => ui.gesture.tool === "select");
  // The program itself is shown beside a resting hand only: while something is drawn the map needs the room.
  const device = useUi((ui) => ui.device !== null);
  const wanted = useUi((ui) => (small && !selected && !device ? ui.programSheet : ui.inspector));
  const zone = useGestures((ui) => ui.zone !== null);
  const touring = useTour((tour) => tour.at !== null);
  const { loaded, canEdit } = useOpenProgram();
  const lifted = (useToolRows(canEdit) - 1) * ROW_PX;
  const inspector = loaded && wanted && (selected || resting);
  const insets = useMemo<Insets>(
    () =>
      small
        ? { left: 40, right: 16, top: 36, bottom: lifted + (tall ? 100 + half : drawerOpen ? 420 : 148) }
        : { left: 100, right: inspector ? 336 : 12, top: 34, bottom: tall ? 24 + half : drawerOpen ? 300 : 62 },
    [small, inspector, drawerOpen, lifted, tall, half],
  );
  // The floor is fitted as if all panels were open: a selected step must not cover the machines.
  const fitInsets = useMemo<Insets>(() => (small ? insets : { ...FITTED }), [small, insets]);
  const style = {
    "--free-right": `${insets.right}px`,
    "--free-bottom": `${insets.bottom}px`,
    "--over-rail": `${82 + lifted}px`,
  } as CSSProperties;
  return (
    <div className={classes.screen}>
      <EditorTop />
      <main className={classes.floor} style={style} data-small={small || undefined}>
        <EditorMap insets={insets} fitInsets={fitInsets} small={small} />
        <Unopened />
        {loaded ? (
          <>
            <ToolRail />
            <Suspense fallback={null}>
              <EmptyProgram />
            </Suspense>
            <HelpSentence />
            <Suspense fallback={null}>
              <NextSteps />
            </Suspense>
            <ModeBar />
            <Toast />
            <NotTaken />
            <ProgramButton small={small} shown={inspector} />
            {inspector ? <Inspector /> : null}
            {zone ? (
              <Suspense fallback={null}>
                <ZoneForm />
              </Suspense>
            ) : null}
            <ContextMenu />
            <QuickAdd />
            <Drawer small={small} />
            {touring ? (
              <Suspense fallback={null}>
                <Tour />
              </Suspense>
            ) : null}
          </>
        ) : null}
      </main>
      <Dialogs />
      <Announcer />
      <Suspense fallback={null}>
        <PaletteOffer />
      </Suspense>
    </div>
  );
}

/** The keys and the clipboard of the gestures, for as long as the editor is on the screen. */
function useGestureInput(): void {
  const open = useOpenProgram();
  useModeKeys(open);
  useOthersEdits(open);
  useCommandKeys(open);
  useRunning(open);
  useClipboard(open, pasteIfScript);
  useEffect(() => resetGestures, [open.program.id]);
}
