/** How much a run matters, when it may begin and by when it should be over. */
import { SegmentedControl, TextInput } from "@mantine/core";
import { PRIORITIES, type TermsForm } from "./runTerms";
import { useTranslation } from "react-i18next";
import classes from "./start.module.css";

export function RunTermsForm({ terms, onChange }: { terms: TermsForm; onChange: (terms: TermsForm) => void }) {
  const { t } = useTranslation();
  return (
    <>
      <div className={classes.labelled}>
        <span id="run-priority">{t("start.run.priority")}</span>
        <SegmentedControl
          fullWidth
          aria-labelledby="run-priority"
          data={PRIORITIES.map((value) => ({ value, label: t(`start.run.priorities.${value}`) }))}
          value={terms.priority}
          onChange={(value) => onChange({ ...terms, priority: value })}
        />
      </div>
      <div className={classes.pair}>
        <TextInput
          type="datetime-local"
          label={t("start.run.not_before")}
          value={terms.notBefore}
          onChange={(event) => onChange({ ...terms, notBefore: event.currentTarget.value })}
        />
        <TextInput
          type="datetime-local"
          label={t("start.run.deadline")}
          value={terms.deadline}
          onChange={(event) => onChange({ ...terms, deadline: event.currentTarget.value })}
        />
      </div>
    </>
  );
}
