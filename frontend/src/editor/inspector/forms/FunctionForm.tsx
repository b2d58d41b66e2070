/** A function of the program: its name, what it takes, what it gives back. */
import { Button } from "@mantine/core";
import { Library } from "lucide-react";
import { Link } from "react-router-dom";
import { changeParameter } from "../../edits/names";
import type { FunctionDefinition } from "@/program/document/document";
import { useOpenProgram } from "../../state/context";
import { useUi } from "../../state/ui";
import classes from "../../panel.module.css";
import { AddParameter } from "../fields/AddParameter";
import { NamedField } from "../fields/NamedField";
import { ParameterCard, TypeFields } from "../fields/ParameterCard";

export function FunctionForm({ functionId, definition }: { functionId: string; definition: FunctionDefinition }) {
  const { t, apply, document, canEdit, site } = useOpenProgram();
  const disabled = !canEdit;
  const store = (change: Partial<FunctionDefinition>) =>
    apply([{ do: "set_function", id: functionId, value: { ...definition, ...change } }]);
  const { parameters } = definition;
  return (
    <>
      <NamedField
        label={t("call.name")}
        value={definition.name}
        disabled={disabled}
        onChange={(name) => store({ name })}
      />
      {definition.source ? (
        <p className={classes.now}>
          <Link
            to={`/sites/${site.slug}/library/${definition.source.library}?from=${definition.source.version}`}
            className={classes.link}
          >
            {t("call.from_library", { version: definition.source.version })}
          </Link>
        </p>
      ) : null}
      <div className={classes.field}>
        <span className={classes.legend}>{t("call.parameters")}</span>
        {parameters.map((parameter, index) => (
          <ParameterCard
            key={index}
            parameter={parameter}
            disabled={disabled}
            onChange={(next) => apply(changeParameter(document, functionId, index, next))}
            onRemove={() => store({ parameters: parameters.filter((_, at) => at !== index) })}
          />
        ))}
        <AddParameter
          taken={parameters}
          disabled={disabled}
          onAdd={(fresh) => store({ parameters: [...parameters, fresh] })}
        />
      </div>
      <Result definition={definition} disabled={disabled} store={store} />
      <Button
        variant="default"
        leftSection={<Library size={15} aria-hidden="true" />}
        disabled={disabled}
        onClick={() => useUi.setState({ dialog: "save_function", dialogFunction: functionId })}
      >
        {t("call.save")}
      </Button>
    </>
  );
}

function Result({
  definition,
  disabled,
  store,
}: {
  definition: FunctionDefinition;
  disabled: boolean;
  store: (change: Partial<FunctionDefinition>) => void;
}) {
  const { t } = useOpenProgram();
  const result = definition.result ?? null;
  return (
    <div className={classes.field}>
      <span className={classes.legend}>{t("call.gives")}</span>
      <TypeFields
        name={t("call.gives")}
        type={result?.type ?? ""}
        unit={result?.unit}
        none={t("call.gives_nothing")}
        disabled={disabled}
        onType={(type) => store({ result: type ? { type } : null })}
        onUnit={(unit) => store({ result: { type: "number", ...(unit ? { unit } : {}) } })}
      />
    </div>
  );
}
