/** Changing a site's map by hand: tools, undo and redo until it is saved as a new version. */
import { Button } from "@mantine/core";
import { Check, Redo2, Undo2, X } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Link, useNavigate } from "react-router-dom";
import { useDevices } from "@/api/queries";
import { isSameMap } from "@/api/wholeMap";
import { rosForm } from "@/map/floor/rosFiles";
import type { Site, SiteMap } from "@/api/types";
import { Chip } from "@/design/Chip";
import { IconButton } from "@/design/IconButton";
import { Panel } from "@/design/Panel";
import { PageShell } from "@/shell/PageShell";
import { EditSurface } from "./EditSurface";
import { LeaveGuard } from "./LeaveGuard";
import styles from "./mapEdit.module.css";
import { SaveDialog } from "./SaveDialog";
import { ToolPanel } from "./ToolPanel";
import { FIRST_SETTINGS } from "./tools";
import { useEditKeys } from "./useEditKeys";
import { useEdits } from "./useEdits";

export function MapEditor({ site, newest }: { site: Site; newest: SiteMap }) {
  const { t } = useTranslation();
  const navigate = useNavigate();
  const [base] = useState(newest);
  const { edits, measured, finish, change, changeLie, undo, redo } = useEdits(base);
  const [settings, set] = useState(FIRST_SETTINGS);
  const [stage, setStage] = useState<"drawing" | "saving" | "saved">("drawing");
  const devices = (useDevices(site.slug).data ?? []).filter(({ lifecycle }) => lifecycle === "approved");
  const isChanged = edits.now !== base;
  const choose = (tool: typeof settings.tool) => set({ ...settings, tool });
  useEditKeys({ choose, undo, redo, isOff: stage !== "drawing" });
  const saved = () => {
    setStage("saved");
    // the guard lets go with the next render
    window.setTimeout(() => void navigate(`/sites/${site.slug}/map`));
  };
  return (
    <PageShell
      title={t("mapEdit.title")}
      chips={<Chip>{t(isChanged ? "mapEdit.unsaved" : "pages.map.version", { version: base.version })}</Chip>}
      actions={
        <>
          <IconButton label={t("mapEdit.undo")} disabled={edits.past.length === 0} onClick={undo}>
            <Undo2 size={17} aria-hidden="true" />
          </IconButton>
          <IconButton label={t("mapEdit.redo")} disabled={edits.future.length === 0} onClick={redo}>
            <Redo2 size={17} aria-hidden="true" />
          </IconButton>
          <Button
            variant="default"
            component={Link}
            to={`/sites/${site.slug}/map`}
            title={t("mapEdit.close")}
            classNames={{ root: styles.action ?? "", label: styles.closeLabel ?? "", section: styles.closeIcon ?? "" }}
            leftSection={<X size={16} aria-hidden="true" />}
          >
            {t("mapEdit.close")}
          </Button>
          <Button
            className={styles.action}
            leftSection={<Check size={16} aria-hidden="true" />}
            disabled={!isChanged}
            onClick={() => setStage("saving")}
          >
            {t("mapEdit.saveAs")}
          </Button>
        </>
      }
    >
      <div className={styles.page}>
        <Panel className={styles.map}>
          <EditSurface
            site={newest}
            map={edits.now}
            devices={devices}
            settings={settings}
            choose={choose}
            finish={(stroke) => finish(settings, stroke)}
            measured={measured}
          />
        </Panel>
        <Panel className={styles.about}>
          {!isSameMap(newest, base) && stage !== "saved" ? (
            <p role="status" className={styles.overtaken}>
              {t("mapEdit.overtaken", { version: newest.version })}
            </p>
          ) : null}
          <ToolPanel
            map={edits.now}
            settings={settings}
            set={set}
            change={change}
            changeLie={changeLie}
            measured={measured}
          />
        </Panel>
      </div>
      {stage === "saving" ? (
        <SaveDialog
          slug={site.slug}
          title={t("mapEdit.ask")}
          action={t("mapEdit.save")}
          makeForm={() => rosForm(edits.now)}
          source="edit"
          base={base}
          newest={newest}
          onSaved={saved}
          onClose={() => setStage("drawing")}
        />
      ) : null}
      <LeaveGuard isOn={isChanged && stage !== "saved"} />
    </PageShell>
  );
}
