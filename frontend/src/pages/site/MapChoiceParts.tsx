/** The parts of a form in which a map is chosen: its files with what a picture needs, and how it looks. */
import { useTranslation } from "react-i18next";
import { Loader } from "@mantine/core";
import { Panel } from "@/design/Panel";
import { problemText } from "@/shell/LoadProblem";
import { MapPane } from "./align/MapPane";
import { DrawingFields } from "./drawing/DrawingFields";
import { DropZone } from "./DropZone";
import styles from "./newsite.module.css";
import { PlanFields } from "./plan/PlanFields";
import { PlanPreview } from "./plan/PlanPreview";
import { Preview } from "./Preview";
import type { MapChoice } from "./useMapChoice";

interface FieldsProps {
  choice: MapChoice;
  problem: string | null;
  choose: (files: readonly File[]) => void;
}

export function MapChoiceFields({ choice, problem, choose }: FieldsProps) {
  const { t } = useTranslation();
  const { picture, reading, drawn, refused, isReading } = choice;
  const ofDrawing = refused ? problemText(refused, t("shell.problem.screen")) : null;
  return (
    <>
      <DropZone
        files={choice.files}
        problem={choice.isUnreadable ? t("mapEdit.plan.unreadable") : (ofDrawing ?? problem)}
        choose={choose}
      />
      {picture && reading ? <PlanFields picture={picture} reading={reading} change={choice.read} /> : null}
      {isReading ? (
        <p role="status">
          <Loader size={14} aria-hidden="true" /> {t("mapImport.reading")}
        </p>
      ) : null}
      {drawn ? <DrawingFields drawing={drawn.drawing} reading={drawn.reading} change={drawn.read} /> : null}
    </>
  );
}

export function MapChoicePreview({ choice }: { choice: MapChoice }) {
  const { t } = useTranslation();
  const { files, picture, reading, drawn } = choice;
  return (
    <Panel className={styles.side}>
      {picture && reading ? (
        <PlanPreview picture={picture} reading={reading} change={(line) => choice.read({ ...reading, line })} />
      ) : drawn?.map ? (
        <MapPane map={drawn.map} title={t("pages.newSite.preview")} />
      ) : files.image && !choice.isUnreadable ? (
        <Preview file={files.image} />
      ) : (
        <p>{t(files.archive ? "mapEdit.archive" : "pages.newSite.previewHere")}</p>
      )}
    </Panel>
  );
}
