/** Where the files of a map are chosen or dropped, with what is there and what is still missing. */
import { Check, FileUp } from "lucide-react";
import { useState, type DragEvent } from "react";
import { useTranslation } from "react-i18next";
import { isUsable, kindOf, type MapFiles } from "./files";
import styles from "./newsite.module.css";

interface DropZoneProps {
  files: MapFiles;
  problem: string | null;
  choose: (files: readonly File[]) => void;
}

export function DropZone({ files, problem, choose }: DropZoneProps) {
  const { t } = useTranslation();
  const [over, setOver] = useState(false);
  const [unusable, setUnusable] = useState<readonly string[]>([]);
  const take = (chosen: readonly File[]) => {
    setUnusable(chosen.filter((file) => !isUsable(file)).map(({ name }) => name));
    choose(chosen);
  };
  const drop = (event: DragEvent) => {
    event.preventDefault();
    setOver(false);
    take([...event.dataTransfer.files]);
  };
  return (
    <div>
      <label
        className={styles.zone}
        data-over={over || undefined}
        data-problem={problem ? true : undefined}
        onDragOver={(event) => {
          event.preventDefault();
          setOver(true);
        }}
        onDragLeave={() => setOver(false)}
        onDrop={drop}
      >
        <FileUp size={22} aria-hidden="true" />
        <b>{t("mapImport.choose")}</b>
        <span>{t("mapImport.chooseText")}</span>
        <input
          type="file"
          multiple
          accept=".yaml,.yml,.pgm,.png,.zip,.jpg,.jpeg,.webp,.dxf"
          className="visually-hidden"
          aria-describedby={problem ? "map-problem" : undefined}
          // The same file chosen again, after it was mended, must count as a choice too.
          onClick={(event) => {
            event.currentTarget.value = "";
          }}
          onChange={(event) => take([...(event.target.files ?? [])])}
        />
      </label>
      <Parts files={files} />
      {unusable.length > 0 ? (
        <p className={styles.problem} role="alert">
          {t("mapImport.unusable", { names: unusable.join(", ") })}
        </p>
      ) : null}
      {problem ? (
        <p id="map-problem" className={styles.problem} role="alert">
          {problem}
        </p>
      ) : null}
    </div>
  );
}

function Parts({ files }: { files: MapFiles }) {
  const { t } = useTranslation();
  const isPicture = kindOf(files) === "picture";
  const two: [string, File | null][] = [
    ["yaml", files.yaml],
    ["image", files.image],
  ];
  const whole = files.archive ?? files.drawing;
  const parts = whole ? [["archive", whole] as const] : isPicture ? two.slice(1) : two;
  return (
    <ul className={styles.parts}>
      {parts.map(([part, file]) => (
        <li key={part} data-there={file ? true : undefined}>
          {file ? <Check size={15} aria-hidden="true" /> : <span className={styles.dot} />}
          {file ? file.name : t(`pages.newSite.missing.${part}`)}
        </li>
      ))}
    </ul>
  );
}
