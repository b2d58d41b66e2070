/** The drawing of a document, rebuilt only when something that it shows has changed. */
import { useEffect, useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { type FloorPlan, floorMark, knownBox, type MapPlace } from "@/map/floor/floor";
import type { Compiled, ProgramDocument } from "../document/document";
import { readTree } from "../document/tree";
import { buildScene, type Scene } from "../scene/scene";
import { pathsOf } from "../scene/stepPaths";
import { measureText } from "../scene/textWidths";
import { type SiteDevice, type Surroundings, surroundingsOf } from "../surroundings";
import type { Translate } from "../words/stepWords";
import { useRoutes } from "./useRoutes";

export interface SceneParts {
  readonly scene: Scene;
  readonly surroundings: Surroundings;
  readonly t: Translate;
}

const NOBODY: ReadonlySet<string> = new Set();
const NO_PLACES: readonly MapPlace[] = [];

export function useScene(input: {
  site: string | undefined;
  plan: FloorPlan | null;
  document: ProgramDocument;
  compiled: Compiled | null | undefined;
  devices: readonly SiteDevice[];
  collapsed?: ReadonlySet<string>;
}): SceneParts {
  const { document, compiled, plan, devices, collapsed = NOBODY } = input;
  const places = plan?.places ?? NO_PLACES;
  const floor = plan && knownBox(plan);
  const t = useEditorText();
  const fonts = useFontsReady();
  const surroundings = useMemo(() => surroundingsOf(devices, places), [devices, places]);
  const keys = useMemo(
    () => pathsOf(document, readTree(document), surroundings).map((way) => way.key),
    [document, surroundings],
  );
  const routes = useRoutes(input.site, floorMark(plan), keys);
  const scene = useMemo(
    () =>
      buildScene({
        document,
        compiled: compiled ?? null,
        surroundings,
        floor,
        routes,
        collapsed,
        t,
        measure: (text, font) => measureText(text, font) + (fonts ? 0 : 0),
      }),
    [document, compiled, surroundings, floor, routes, collapsed, t, fonts],
  );
  return { scene, surroundings, t };
}

/** `t("tool.move")` for `editor.tool.move`. */
export function useEditorText(): Translate {
  const { t } = useTranslation();
  return useMemo<Translate>(() => (key, values) => String(t(`editor.${key}`, values ?? {})), [t]);
}

function useFontsReady(): boolean {
  const [ready, setReady] = useState(() => document.fonts?.status === "loaded");
  useEffect(() => {
    let here = true;
    void document.fonts?.ready.then(() => {
      if (here) setReady(true);
    });
    return () => {
      here = false;
    };
  }, []);
  return ready;
}
