/** The fields of a setting in a panel, with what it is for above them and the button that saves them behind them. */
import { Button } from "@mantine/core";
import type { FormEvent, ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { Panel } from "@/design/Panel";
import styles from "./setting.module.css";

interface SettingFormProps {
  heading: string;
  intro: string;
  /** What else there is to know, below the fields. */
  foot: string;
  isSaving: boolean;
  /** Whether a field holds what cannot be saved. */
  isWrong?: boolean;
  onSave: () => void;
  children: ReactNode;
}

export function SettingForm({ heading, intro, foot, isSaving, isWrong, onSave, children }: SettingFormProps) {
  const { t } = useTranslation();
  const onSubmit = (event: FormEvent) => {
    event.preventDefault();
    if (!isWrong) onSave();
  };
  return (
    <Panel className={styles.setting} aria-label={heading}>
      <h2>{heading}</h2>
      <p>{intro}</p>
      <form onSubmit={onSubmit} className={styles.fields}>
        {children}
        <Button type="submit" className={styles.save} loading={isSaving} disabled={isWrong}>
          {t("people.saveSetting")}
        </Button>
      </form>
      <p>{foot}</p>
    </Panel>
  );
}
