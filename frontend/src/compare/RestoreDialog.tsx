/** Before something is restored: what it changes and what it needs besides. */
import { Button, Modal } from "@mantine/core";
import { useTranslation } from "react-i18next";
import type { ConstructChange } from "@/api/types";
import { VipoIcon } from "@/design/VipoIcon";
import styles from "./compare.module.css";
import { useConstructWords } from "./useConstructWords";
import type { Pictures } from "./usePictures";
import type { Asked, Restore } from "./useRestore";

export function RestoreDialog(props: { restore: Restore; version: number | null; pictures: Pictures }) {
  const { restore, version, pictures } = props;
  const { t } = useTranslation();
  const { asked } = restore;
  return (
    <Modal
      opened={asked !== null}
      onClose={restore.close}
      title={t("compare.restore_title", { number: asked?.version ?? version })}
      size={460}
    >
      {asked ? <Question asked={asked} restore={restore} pictures={pictures} /> : null}
    </Modal>
  );
}

function Question({ asked, restore, pictures }: { asked: Asked; restore: Restore; pictures: Pictures }) {
  const { t } = useTranslation();
  const wordsOf = useConstructWords(pictures);
  const { needs, changes } = asked.found;
  const named = needs.map(([root, id]) => ({
    key: `${root}/${id}`,
    ...wordsOf({ root: root as ConstructChange["root"], id }),
  }));
  const subject = asked.wanted.what === "all" ? null : wordsOf(asked.wanted.change);
  const none = changes.length === 0;
  return (
    <div className={styles.question}>
      {none ? <p>{t("compare.is_already")}</p> : <p>{t("compare.will_change", { count: changes.length })}</p>}
      {named.length > 0 ? (
        <>
          <p>{t("compare.needs", { name: `${subject?.number ?? ""} ${subject?.title ?? ""}`.trim() })}</p>
          <ul>
            {named.map((each) => (
              <li key={each.key}>
                {each.number ? <span className={styles.number}>{each.number}</span> : null}
                {each.icon ? <VipoIcon name={each.icon} size={15} /> : null}
                {each.title}
              </li>
            ))}
          </ul>
        </>
      ) : null}
      {none ? null : <p className={styles.note}>{t("compare.kept_first")}</p>}
      <div className={styles.buttons}>
        <Button variant="default" onClick={restore.close}>
          {t("compare.cancel")}
        </Button>
        {none ? null : (
          <Button data-autofocus loading={restore.busy} onClick={restore.confirm}>
            {named.length > 0 ? t("compare.restore_count", { count: named.length + 1 }) : t("compare.restore")}
          </Button>
        )}
      </div>
    </div>
  );
}
