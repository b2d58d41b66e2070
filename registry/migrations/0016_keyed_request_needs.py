from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [("registry", "0015_tokens_at_the_broker")]

    operations = [migrations.AddField("keyedrequest", "needs", models.JSONField(null=True))]
